//! The clock: processor seconds of this thread if the system provides them, otherwise wall-clock seconds.

/// The name of the clock in prose.
#[cfg(any(target_os = "linux", target_os = "macos"))]
pub(super) const NAME: &str = "processor time";
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
pub(super) const NAME: &str = "wall-clock time";

/// Seconds since some moment.
#[cfg(any(target_os = "linux", target_os = "macos"))]
fn now() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    #[allow(clippy::cast_precision_loss)] // seconds of a process
    let seconds = time.tv_sec as f64;
    #[allow(clippy::cast_precision_loss)] // below 10⁹
    let nanoseconds = time.tv_nsec as f64;
    seconds + 1e-9 * nanoseconds
}

/// Seconds since some moment.
#[cfg(not(any(target_os = "linux", target_os = "macos")))]
fn now() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}

/// Seconds of `work`, whose result is kept from being optimized away.
pub(super) fn seconds<R>(work: impl FnOnce() -> R) -> f64 {
    let start = now();
    core::hint::black_box(work());
    now() - start
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_goes_forward_with_work() {
        let mut sum = 0_u64;
        let spent = seconds(|| {
            let start = now();
            while now() < start + 1e-4 {
                sum += 1;
            }
            sum
        });
        assert!(spent >= 1e-4, "{spent}");
    }
}
