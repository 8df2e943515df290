//! The C functions of FMI 3.0 (<https://fmi-standard.org>) for co-simulation: the only file of the crate with `unsafe`.
//!
//! A function turns the pointers of its caller into values, and leaves the work to [`Instance`]. No panic leaves a
//! function. Everything belongs to an instance, so that several of them step on several threads at once.
//!
//! # Safety
//! Every function relies on the requirements of FMI on a caller, which the compiler cannot check: an instance comes
//! from [`fmi3InstantiateCoSimulation`] and is not freed, a state from [`fmi3GetFMUState`] or
//! [`fmi3DeserializeFMUState`]; no two functions of one instance run at once; arrays have the given lengths, and texts
//! end with a zero.

#![allow(unsafe_code, reason = "names and pointers of C")]
#![allow(non_snake_case, reason = "names of FMI")]
#![allow(clippy::missing_safety_doc, reason = "one contract for all, above")]
#![allow(clippy::too_many_arguments, clippy::similar_names, reason = "signatures of FMI")]

use crate::Unit;
use crate::instance::{Instance, State};
use core::ffi::{CStr, c_char, c_void};
use core::ptr;
use std::ffi::CString;
use std::panic::{AssertUnwindSafe, catch_unwind};

// SAFETY: `unit!` defines it with this signature.
unsafe extern "Rust" {
    safe fn variational_unit() -> Unit;
}

/// `fmi3Status`, of which these are used.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// `fmi3OK`.
    Ok = 0,
    /// `fmi3Error`.
    Error = 3,
    /// `fmi3Fatal`.
    Fatal = 4,
}

/// `fmi3LogMessageCallback`: environment, status, category, message.
type LogMessage = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

/// The receiver of messages.
struct Log {
    to: Option<LogMessage>,
    environment: *mut c_void,
}

impl Log {
    fn write(&self, status: Status, message: &str) {
        let message = CString::new(message.replace('\0', " ")).unwrap_or_default();
        if let Some(to) = self.to {
            // SAFETY: the caller gave this function with this environment, and both texts end with a zero.
            unsafe { to(self.environment, status, c"logStatusError".as_ptr(), message.as_ptr()) };
        }
    }
}

/// `fmi3Instance`.
pub struct Handle {
    /// None after a panic.
    instance: Option<Instance>,
    log: Log,
}

/// Runs a function of an instance, and logs its error. After a panic an instance can only be freed.
unsafe fn call(handle: *mut Handle, of: impl FnOnce(&mut Instance) -> Result<(), String>) -> Status {
    // SAFETY: the pointer is null or that of an instance, which nobody else uses at the moment.
    let Some(handle) = (unsafe { handle.as_mut() }) else { return Status::Error };
    let Some(instance) = &mut handle.instance else { return Status::Fatal };
    let (status, message) = match catch_unwind(AssertUnwindSafe(|| of(instance))) {
        Ok(Ok(())) => return Status::Ok,
        Ok(Err(message)) => (Status::Error, message),
        Err(_) => {
            handle.instance = None;
            (
                Status::Fatal,
                "a mistake in the unit, please report it: its panic is in the output of the program".to_owned(),
            )
        }
    };
    handle.log.write(status, &message);
    status
}

/// An array of the caller, which is not written meanwhile.
unsafe fn array<'a, T>(first: *const T, count: usize) -> Result<&'a [T], String> {
    match count {
        0 => Ok(&[]),
        _ if first.is_null() => Err("an array is missing".to_owned()),
        // SAFETY: the array has this length.
        _ => Ok(unsafe { core::slice::from_raw_parts(first, count) }),
    }
}

/// Writes into a place of the caller, if there is one.
unsafe fn write<T>(to: *mut T, value: T) {
    if !to.is_null() {
        // SAFETY: the place belongs to the caller of this function.
        unsafe { to.write(value) };
    }
}

/// Writes into an array of the caller.
unsafe fn write_all<T: Copy>(to: *mut T, count: usize, values: &[T]) -> Result<(), String> {
    match count {
        0 if values.is_empty() => {}
        _ if count != values.len() => return Err(format!("the array has {count} places for {} values", values.len())),
        _ if to.is_null() => return Err("an array is missing".to_owned()),
        // SAFETY: the array has this length, and is not one of this library.
        _ => unsafe { ptr::copy_nonoverlapping(values.as_ptr(), to, count) },
    }
    Ok(())
}

/// The version of FMI.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Does nothing: errors are always logged, and there are no other messages.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    handle: *mut Handle,
    _logging_on: bool,
    _count: usize,
    _categories: *const *const c_char,
) -> Status {
    unsafe { call(handle, |_| Ok(())) }
}

/// A new instance; null if the token is that of another unit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging_on: bool,
    _event_mode_used: bool,
    _early_return_allowed: bool,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    log: Option<LogMessage>,
    _intermediate_update: *const c_void,
) -> *mut Handle {
    let log = Log { to: log, environment };
    // SAFETY: a text that is not null ends with a zero.
    let token = (!token.is_null()).then(|| unsafe { CStr::from_ptr(token) });
    let instance = catch_unwind(|| {
        let unit = variational_unit();
        (token.map(CStr::to_bytes) == Some(unit.token.as_bytes())).then(|| Instance::new(unit))
    });
    match instance {
        Ok(Some(instance)) => Box::into_raw(Box::new(Handle { instance: Some(instance), log })),
        Ok(None) => {
            log.write(Status::Error, "the instantiation token is not that of this unit");
            ptr::null_mut()
        }
        Err(_) => {
            log.write(Status::Fatal, "the unit cannot be made: its panic is in the output of the program");
            ptr::null_mut()
        }
    }
}

/// Deletes an instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(handle: *mut Handle) {
    if !handle.is_null() {
        // SAFETY: the instance is not freed yet.
        drop(unsafe { Box::from_raw(handle) });
    }
}

/// Begins the initialization.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    handle: *mut Handle,
    _has_tolerance: bool,
    _tolerance: f64,
    start: f64,
    _has_stop: bool,
    _stop: f64,
) -> Status {
    unsafe { call(handle, |of| of.initialize(start)) }
}

/// Ends the initialization: the run begins.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(handle: *mut Handle) -> Status {
    unsafe { call(handle, Instance::end_initialization) }
}

/// Does nothing: the outputs stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(handle: *mut Handle) -> Status {
    unsafe { call(handle, |_| Ok(())) }
}

/// Starts again with the start values of the unit.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(handle: *mut Handle) -> Status {
    unsafe {
        call(handle, |of| {
            of.reset();
            Ok(())
        })
    }
}

/// The values of variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    handle: *mut Handle,
    references: *const u32,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> Status {
    unsafe { call(handle, |of| write_all(values, value_count, &of.get(array(references, count)?)?)) }
}

/// Sets variables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    handle: *mut Handle,
    references: *const u32,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    unsafe { call(handle, |of| of.set(array(references, count)?, array(values, value_count)?)) }
}

/// Takes a communication step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    handle: *mut Handle,
    from: f64,
    length: f64,
    _no_state_before: bool,
    needs_event: *mut bool,
    terminates: *mut bool,
    returns_early: *mut bool,
    reached: *mut f64,
) -> Status {
    unsafe {
        call(handle, |of| {
            for flag in [needs_event, terminates, returns_early] {
                write(flag, false);
            }
            let outcome = of.step(from, length);
            write(reached, of.time());
            outcome
        })
    }
}

/// Copies the state of an instance, into a copy of before if there is one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(handle: *mut Handle, state: *mut *mut State) -> Status {
    unsafe { call(handle, |of| put(state, of.save())) }
}

/// Puts a state into a place of the caller, which is null or has another one.
unsafe fn put(place: *mut *mut State, state: State) -> Result<(), String> {
    // SAFETY: the place is the caller's, and what it has is null or a state.
    match unsafe { place.as_mut() } {
        None => return Err("the place of the state is missing".to_owned()),
        Some(place) if place.is_null() => *place = Box::into_raw(Box::new(state)),
        Some(place) => unsafe { **place = state },
    }
    Ok(())
}

/// A state of the caller.
unsafe fn state<'a>(state: *const State) -> Result<&'a State, String> {
    // SAFETY: the pointer is null or that of a state.
    unsafe { state.as_ref() }.ok_or_else(|| "the state is missing".to_owned())
}

/// Continues from a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(handle: *mut Handle, from: *const State) -> Status {
    unsafe {
        call(handle, |of| {
            of.restore(state(from)?);
            Ok(())
        })
    }
}

/// Deletes a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(handle: *mut Handle, place: *mut *mut State) -> Status {
    unsafe {
        call(handle, |_| {
            if let Some(place) = place.as_mut().filter(|place| !place.is_null()) {
                // SAFETY: the state is not freed yet.
                drop(Box::from_raw(core::mem::replace(place, ptr::null_mut())));
            }
            Ok(())
        })
    }
}

/// The number of bytes of a stored state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(handle: *mut Handle, of: *const State, size: *mut usize) -> Status {
    unsafe {
        call(handle, |_| {
            write(size, Instance::stored(state(of)?)?.len());
            Ok(())
        })
    }
}

/// Stores a state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    handle: *mut Handle,
    of: *const State,
    bytes: *mut u8,
    size: usize,
) -> Status {
    unsafe { call(handle, |_| write_all(bytes, size, &Instance::stored(state(of)?)?)) }
}

/// The state of stored bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    handle: *mut Handle,
    bytes: *const u8,
    size: usize,
    place: *mut *mut State,
) -> Status {
    unsafe { call(handle, |of| put(place, of.loaded(array(bytes, size)?)?)) }
}

/// No unit of this kind.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging_on: bool,
    _environment: *mut c_void,
    _log: Option<LogMessage>,
) -> *mut Handle {
    ptr::null_mut()
}

/// No unit of this kind.
#[unsafe(no_mangle)]
pub extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging_on: bool,
    _environment: *mut c_void,
    _log: Option<LogMessage>,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut Handle {
    ptr::null_mut()
}

/// Functions of the other kinds of variables, modes and units. Tools look all of them up.
macro_rules! refused {
    ($($name:ident($($argument:ty),*);)*) => {$(
        /// A function of FMI for what the unit does not have.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $name(handle: *mut Handle, $(_: $argument),*) -> Status {
            unsafe { call(handle, |_| Err(concat!("the unit does not have ", stringify!($name)).to_owned())) }
        }
    )*};
}

type References = *const u32;

refused! {
    fmi3EnterEventMode();
    fmi3EnterStepMode();
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(*mut bool, *mut bool, *mut bool, *mut bool, *mut bool, *mut f64);
    fmi3GetFloat32(References, usize, *mut f32, usize);
    fmi3GetInt8(References, usize, *mut i8, usize);
    fmi3GetUInt8(References, usize, *mut u8, usize);
    fmi3GetInt16(References, usize, *mut i16, usize);
    fmi3GetUInt16(References, usize, *mut u16, usize);
    fmi3GetInt32(References, usize, *mut i32, usize);
    fmi3GetUInt32(References, usize, *mut u32, usize);
    fmi3GetInt64(References, usize, *mut i64, usize);
    fmi3GetUInt64(References, usize, *mut u64, usize);
    fmi3GetBoolean(References, usize, *mut bool, usize);
    fmi3GetString(References, usize, *mut *const c_char, usize);
    fmi3GetBinary(References, usize, *mut usize, *mut *const u8, usize);
    fmi3GetClock(References, usize, *mut bool);
    fmi3SetFloat32(References, usize, *const f32, usize);
    fmi3SetInt8(References, usize, *const i8, usize);
    fmi3SetUInt8(References, usize, *const u8, usize);
    fmi3SetInt16(References, usize, *const i16, usize);
    fmi3SetUInt16(References, usize, *const u16, usize);
    fmi3SetInt32(References, usize, *const i32, usize);
    fmi3SetUInt32(References, usize, *const u32, usize);
    fmi3SetInt64(References, usize, *const i64, usize);
    fmi3SetUInt64(References, usize, *const u64, usize);
    fmi3SetBoolean(References, usize, *const bool, usize);
    fmi3SetString(References, usize, *const *const c_char, usize);
    fmi3SetBinary(References, usize, *const usize, *const *const u8, usize);
    fmi3SetClock(References, usize, *const bool);
    fmi3GetNumberOfVariableDependencies(u32, *mut usize);
    fmi3GetVariableDependencies(u32, *mut usize, *mut u32, *mut usize, *mut i32, usize);
    fmi3GetDirectionalDerivative(References, usize, References, usize, *const f64, usize, *mut f64, usize);
    fmi3GetAdjointDerivative(References, usize, References, usize, *const f64, usize, *mut f64, usize);
    fmi3GetIntervalDecimal(References, usize, *mut f64, *mut i32);
    fmi3GetIntervalFraction(References, usize, *mut u64, *mut u64, *mut i32);
    fmi3GetShiftDecimal(References, usize, *mut f64);
    fmi3GetShiftFraction(References, usize, *mut u64, *mut u64);
    fmi3SetIntervalDecimal(References, usize, *const f64);
    fmi3SetIntervalFraction(References, usize, *const u64, *const u64);
    fmi3SetShiftDecimal(References, usize, *const f64);
    fmi3SetShiftFraction(References, usize, *const u64, *const u64);
    fmi3GetOutputDerivatives(References, usize, *const i32, *mut f64, usize);
    fmi3ActivateModelPartition(u32, f64);
    fmi3EnterContinuousTimeMode();
    fmi3CompletedIntegratorStep(bool, *mut bool, *mut bool);
    fmi3SetTime(f64);
    fmi3SetContinuousStates(*const f64, usize);
    fmi3GetContinuousStateDerivatives(*mut f64, usize);
    fmi3GetEventIndicators(*mut f64, usize);
    fmi3GetContinuousStates(*mut f64, usize);
    fmi3GetNominalsOfContinuousStates(*mut f64, usize);
    fmi3GetNumberOfEventIndicators(*mut usize);
    fmi3GetNumberOfContinuousStates(*mut usize);
}
