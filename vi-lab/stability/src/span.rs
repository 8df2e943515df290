//! The quantity on an axis of a system's map, and its range.
//!
//! In: `NAME=LOW:HIGH`. Out: a [`Span`].

use vi_report::chart::Axis;
use vi_report::entry::Entry;
use vi_report::failure::Failure;
use vi_report::quantity::Quantity;

/// A quantity with its range.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Span {
    /// The quantity.
    pub(super) quantity: Quantity,
    /// Its name, as on the command line.
    pub(super) name: String,
    /// The limits of the range.
    pub(super) range: (f64, f64),
}

impl Span {
    /// The span that `text` names.
    ///
    /// # Errors
    /// [`Failure::Input`] if there is no such quantity, or no such range.
    pub(super) fn parse(entry: &Entry, text: &str) -> Result<Self, Failure> {
        let wrong = || Failure::Input(format!("an axis is given as NAME=LOW:HIGH, with LOW below HIGH, not `{text}`"));
        let (name, range) = text.split_once('=').ok_or_else(wrong)?;
        let (low, high) = range.split_once(':').ok_or_else(wrong)?;
        let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(wrong);
        let range = (number(low)?, number(high)?);
        if range.0 >= range.1 {
            return Err(wrong());
        }
        let quantity = Quantity::named(entry.system.as_ref(), name.trim())?;
        if quantity == Quantity::Step && range.0 <= 0.0 {
            return Err(Failure::Input(format!("the step h must be positive, not `{text}`")));
        }
        Ok(Self { quantity, name: name.trim().to_owned(), range })
    }

    /// Whether a value lies in the range.
    pub(super) fn contains(&self, value: f64) -> bool {
        (self.range.0..=self.range.1).contains(&value)
    }

    /// The axis that shows it: the step by its logarithm.
    pub(super) fn axis(&self) -> Axis {
        let axis = match self.quantity {
            Quantity::Step => Axis::log10("first step h"),
            Quantity::Coordinate(_) | Quantity::Velocity(_) => Axis::linear(format!("initial {}", self.name)),
            Quantity::Parameter(_) => Axis::linear(self.name.clone()),
        };
        axis.over(self.range.0, self.range.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::catalogue;

    #[test]
    fn axes_are_read_and_mistakes_named() {
        let entry = catalogue().find("kepler").unwrap_or_else(|failure| panic!("{failure}"));
        let span = |text: &str| Span::parse(&entry, text).map_err(|failure| failure.to_string());
        assert_eq!(span("y=-1:2").map(|span| (span.quantity, span.range)), Ok((Quantity::Coordinate(1), (-1.0, 2.0))));
        assert_eq!(span("v_x=0:1").map(|span| span.quantity), Ok(Quantity::Velocity(0)));
        assert_eq!(span("mu=0.1:2").map(|span| span.quantity), Ok(Quantity::Parameter("mu".to_owned())));
        assert_eq!(span("h=0.1:2").map(|span| span.quantity), Ok(Quantity::Step));
        let unknown = "there is no quantity `z` to vary; the quantities are x, y, v_x, v_y, mu, h";
        assert_eq!(span("z=0:1"), Err(unknown.to_owned()));
        assert_eq!(span("h=0:1"), Err("the step h must be positive, not `h=0:1`".to_owned()));
        for text in ["x", "x=1", "x=2:1", "x=1:1", "x=a:b", "x=0:inf"] {
            assert_eq!(
                span(text),
                Err(format!("an axis is given as NAME=LOW:HIGH, with LOW below HIGH, not `{text}`"))
            );
        }
    }
}
