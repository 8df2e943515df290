//! The functions that the page calls, with one buffer for text and one for numbers.
//!
//! In: a text or numbers in a buffer, whose length the page has set. Out: whether it succeeded; the answer is in the
//! buffer. A page has one thread, and one system at a time.
#![allow(unsafe_code, reason = "a name for another language; no other function of the program has it")]

use crate::facts::{Length, Model};
use crate::motion::Motion;
use serde_json::json;
use std::cell::RefCell;
use vi_core::StepError;

/// The buffers, the system and its run.
#[derive(Default)]
struct Page {
    text: Vec<u8>,
    numbers: Vec<f64>,
    model: Option<Model>,
    motion: Option<Motion>,
}

thread_local! {
    static PAGE: RefCell<Page> = RefCell::default();
}

impl Page {
    /// Writes an answer; returns whether it is no error.
    fn answer(&mut self, answer: Result<String, String>) -> bool {
        let is_right = answer.is_ok();
        self.text = answer.unwrap_or_else(|error| error).into_bytes();
        is_right
    }

    fn compiled(&mut self) -> Result<String, String> {
        self.model = None;
        self.motion = None;
        let model = Model::of(&String::from_utf8_lossy(&self.text))?;
        Ok(self.model.insert(model).facts())
    }

    fn started(&self, method: usize, length: Length) -> Result<Motion, String> {
        let model = self.model.as_ref().ok_or("there is no system")?;
        let planned = model.planned(method, length, &self.numbers);
        planned.and_then(|(system, plan)| Motion::begin(system, &plan)).map_err(reason)
    }

    fn begun(&mut self, method: usize, length: Length) -> Result<String, String> {
        self.motion = None;
        let motion = self.started(method, length)?;
        let motion = self.motion.insert(motion);
        Ok(json!({ "h": motion.h(), "energy": motion.initial_energy }).to_string())
    }

    fn advanced(&mut self, end: f64, most: u32) -> Result<String, String> {
        self.numbers.clear();
        let motion = self.motion.as_mut().ok_or("there is no run")?;
        motion.advance(end, most, &mut self.numbers).map(|()| String::new()).map_err(reason)
    }
}

/// The reason of an error. The advice is for programs.
#[allow(clippy::needless_pass_by_value, reason = "an argument of `map_err`")]
fn reason(error: StepError) -> String {
    error.reason().to_string()
}

fn with<T>(of: impl FnOnce(&mut Page) -> T) -> T {
    PAGE.with_borrow_mut(of)
}

/// The address of the buffer for text, with this number of bytes.
#[unsafe(no_mangle)]
extern "C" fn text_of(bytes: usize) -> *const u8 {
    with(|page| {
        page.text.resize(bytes, 0);
        page.text.as_ptr()
    })
}

/// The address of the buffer for numbers, with this number of them.
#[unsafe(no_mangle)]
extern "C" fn numbers_of(count: usize) -> *const f64 {
    with(|page| {
        page.numbers.resize(count, 0.0);
        page.numbers.as_ptr()
    })
}

/// The number of bytes of the last answer.
#[unsafe(no_mangle)]
extern "C" fn text_length() -> usize {
    with(|page| page.text.len())
}

/// The count of numbers of the last answer.
#[unsafe(no_mangle)]
extern "C" fn numbers_length() -> usize {
    with(|page| page.numbers.len())
}

/// Compiles the text. Answers with facts or mistakes.
#[unsafe(no_mangle)]
extern "C" fn compile() -> bool {
    with(|page| {
        let answer = page.compiled();
        page.answer(answer)
    })
}

/// Begins a run with all parameters, coordinates and velocities in the buffer for numbers; a step of the length h, or for
/// h = 0 of a length with this tolerance. Answers with the length and H.
#[unsafe(no_mangle)]
extern "C" fn begin(method: usize, h: f64, tolerance: f64) -> bool {
    with(|page| {
        let length = if h == 0.0 { Length::Within(tolerance) } else { Length::Of(h) };
        let answer = page.begun(method, length);
        page.answer(answer)
    })
}

/// Takes steps until the time `end`, at most `most`. Their rows are the numbers, also of steps before one that failed.
#[unsafe(no_mangle)]
extern "C" fn advance(end: f64, most: u32) -> bool {
    with(|page| {
        let answer = page.advanced(end, most);
        page.answer(answer)
    })
}

/// Takes steps of another run from the same start, for their time.
#[unsafe(no_mangle)]
extern "C" fn measure(method: usize, h: f64, steps: u32) -> bool {
    with(|page| page.started(method, Length::Of(h)).is_ok_and(|mut motion| motion.advance_by(steps).is_ok()))
}
