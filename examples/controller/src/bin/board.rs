//! The controller on a Cortex-M4, with the pendulum beside it. QEMU runs it:
//!
//! ```text
//! rustup target add thumbv7em-none-eabihf
//! cargo run --release --features board --target thumbv7em-none-eabihf
//! ```

#![no_std]
#![no_main]

use controller::Controller;
use controller::pendulum::Pendulum;
use core::panic::PanicInfo;
use core::ptr;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::{Peripherals, asm};
use cortex_m_rt::entry;
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hprintln;
use vi_core::StepError;

/// Instructions between two ticks of the emulated clock of 25 MHz, at a nanosecond an instruction.
const INSTRUCTIONS: u32 = 40;
/// The clock counts down from here.
const LATEST: u32 = 0x00ff_ffff;
/// The word that the start of the program writes to the whole stack.
const UNUSED: u32 = 0xcccc_cccc;

unsafe extern "C" {
    static _stack_end: u32;
    static _stack_start: u32;
}

#[entry]
fn main() -> ! {
    if let Some(Peripherals { SYST: mut clock, .. }) = Peripherals::take() {
        clock.set_clock_source(SystClkSource::Core);
        clock.set_reload(LATEST);
        clock.clear_current();
        clock.enable_counter();
    }
    let outcome = alone().and_then(|()| controlled());
    debug::exit(if outcome.is_ok() { EXIT_SUCCESS } else { EXIT_FAILURE });
    loop {
        asm::wfi();
    }
}

/// The force for a pendulum that does not move, ten times, and what this took.
///
/// # Errors
/// The errors of a step.
#[inline(never)]
fn alone() -> Result<(), StepError> {
    let mut controller = Controller::new([0.0, 0.1])?;
    let mut longest = 0;
    for _ in 0..10 {
        let start = SYST::get_current();
        controller.force([0.0, 0.1])?;
        longest = longest.max(instructions_since(start));
    }
    hprintln!("controller alone: {} instructions a period, stack {} bytes", longest, stack());
    Ok(())
}

/// Keeps the pendulum upright for four seconds, and prints its angle each half.
///
/// # Errors
/// The errors of a step.
#[inline(never)]
fn controlled() -> Result<(), StepError> {
    let mut pendulum = Pendulum::at_rest(0.25)?;
    let mut controller = Controller::new(pendulum.measured())?;
    let (mut force, mut angle) = (0.0, 0.0_f64);
    for period in 0..800 {
        let next = controller.force(pendulum.measured())?;
        let start = SYST::get_current();
        angle = pendulum.pushed(force)?.q[1];
        let instructions = instructions_since(start);
        force = next;
        if period % 100 == 0 {
            hprintln!("angle {} mrad; {} instructions for the pendulum", (angle * 1e3) as i32, instructions);
        }
    }
    hprintln!("with the pendulum: stack {} bytes", stack());
    // The same number as in `tests/loop.rs`.
    hprintln!("the bits of its last angle: {:#018x}", angle.to_bits());
    Ok(())
}

fn instructions_since(start: u32) -> u32 {
    (start.wrapping_sub(SYST::get_current()) & LATEST) * INSTRUCTIONS
}

/// Bytes of the stack that were used so far.
fn stack() -> usize {
    // SAFETY: the linker gives both ends of the stack; all words between them can be read.
    unsafe {
        let (mut word, start) = (&raw const _stack_end, &raw const _stack_start);
        while word < start && ptr::read_volatile(word) == UNUSED {
            word = word.add(1);
        }
        start.addr() - word.addr()
    }
}

#[panic_handler]
fn panicked(_: &PanicInfo<'_>) -> ! {
    debug::exit(EXIT_FAILURE);
    loop {
        asm::wfi();
    }
}
