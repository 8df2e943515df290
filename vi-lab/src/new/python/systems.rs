
/// The systems for Python, and the integrators that are built for each.
#[cfg(feature = "python")]
#[must_use]
pub fn systems() -> Vec<Box<dyn vi_erased::System>> {
    vec![vi_erased::kind!(SpringPendulum, { fixed; gauss 4, 8; energy })]
}
