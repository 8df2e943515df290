//! The tables of a text.

use vi_codegen::model::{FunctionKind, Model, Outside, Table, TableKind, Values};
use vi_core::table::{self, AnyTable, Interpolation};

/// The tables of a system, in the order of their declaration.
#[derive(Clone, Debug)]
pub(crate) struct Tables {
    names: Vec<String>,
    pub(crate) all: &'static [AnyTable],
}

impl Tables {
    /// `None` with a Rust function.
    pub(crate) fn of(model: &Model) -> Option<Self> {
        let table = |kind: &FunctionKind| match kind {
            FunctionKind::Table(table) => Some(computed(table)),
            FunctionKind::Rust(_) => None,
        };
        let all: Vec<AnyTable> = model.functions.iter().map(|of| table(&of.kind)).collect::<Option<_>>()?;
        let names = model.functions.iter().map(|of| of.name.to_string()).collect();
        Some(Self { names, all: all.leak() })
    }

    /// The place of the table of this name.
    pub(crate) fn place(&self, name: &str) -> Option<u16> {
        self.names.iter().position(|known| known == name)?.try_into().ok()
    }
}

fn computed(of: &Table) -> AnyTable {
    let interpolation = match of.kind {
        TableKind::Linear => Interpolation::Linear,
        TableKind::Monotone => Interpolation::Monotone,
        TableKind::Cubic => Interpolation::Cubic,
        TableKind::Quintic => Interpolation::Quintic,
    };
    let outside = match of.outside {
        Outside::Nothing => table::Outside::Undefined,
        Outside::Hold => table::Outside::Hold,
        Outside::Extend => table::Outside::Extend,
        Outside::Periodic => table::Outside::Periodic,
    };
    match &of.values {
        Values::Points { places, values } => AnyTable::points(places, values, interpolation, outside),
        Values::Grid { places: [x, y], rows } => AnyTable::grid([x, y], &rows.concat(), interpolation, outside),
        Values::Parameters { ends, count, .. } => AnyTable::uniform(*ends, *count, interpolation, outside),
    }
}
