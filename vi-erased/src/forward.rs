//! Forwarding for wrappers that hold a system or a run as `of`: the functions that every wrapper forwards, a list for
//! each trait.

/// Writes functions that call those of the field `of`: `forward!(Steps);` those of a list,
/// `forward! { fn p(&self) -> &[f64]; }` further ones.
#[doc(hidden)]
#[macro_export]
macro_rules! forward {
    (System) => {
        $crate::forward! {
            fn name(&self) -> &'static str;
            fn about(&self) -> &'static str;
            fn definition(&self) -> &'static str;
            fn constraints(&self) -> &'static [&'static str];
            fn parameters(&self) -> Vec<(&'static str, f64)>;
            fn parameters_about(&self) -> &'static [&'static str];
            fn set(&mut self, name: &str, value: f64) -> bool;
            fn integrators(&self) -> Vec<$crate::Built>;
            fn offers(&self, wanted: $crate::Built) -> Result<(), ::vi_core::StepError>;
            fn conserves_energy(&self) -> bool;
        }
    };
    (Steps) => {
        $crate::forward! {
            fn t(&self) -> f64;
            fn h(&self) -> f64;
            fn energy(&self) -> Result<f64, ::vi_core::StepError>;
            fn discrete_energy(&self) -> Option<f64>;
            fn shifted_energy(&self) -> Option<$crate::simulation::ShiftedEnergy>;
            fn constraints(&self) -> Option<$crate::simulation::AtConstraints>;
            fn advance_to(&mut self, end: f64) -> Result<(), ::vi_core::StepError>;
            fn monitor(&mut self) -> ();
        }
    };
    (Simulation) => {
        $crate::forward! {
            fn evaluations(&self) -> u64;
            fn sampled_energy(&self) -> Result<(f64, f64), ::vi_core::StepError>;
        }
    };
    ($(#[$attribute:meta])* fn $name:ident(&mut $this:ident $(, $of:ident: $type:ty)*) -> $out:ty; $($rest:tt)*) => {
        $(#[$attribute])*
        fn $name(&mut $this $(, $of: $type)*) -> $out {
            $this.of.$name($($of),*)
        }
        $crate::forward! { $($rest)* }
    };
    ($(#[$attribute:meta])* fn $name:ident(&$this:ident $(, $of:ident: $type:ty)*) -> $out:ty; $($rest:tt)*) => {
        $(#[$attribute])*
        fn $name(&$this $(, $of: $type)*) -> $out {
            $this.of.$name($($of),*)
        }
        $crate::forward! { $($rest)* }
    };
    () => {};
}
