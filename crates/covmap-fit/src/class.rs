//! The classes of cells that are scored apart.

use serde::Serialize;

/// A coverage this near to 0 or to 1 is one of them: exact coverages are good to this.
const EXACT: f64 = 1e-9;

/// The class of a cell by its true coverage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// Coverage 0.
    Free,
    /// A coverage between 0 and 1.
    Partial,
    /// Coverage 1.
    Solid,
}

impl Class {
    /// The class of a true coverage.
    pub fn of(coverage: f64) -> Self {
        match coverage {
            c if c < EXACT => Self::Free,
            c if c > 1.0 - EXACT => Self::Solid,
            _ => Self::Partial,
        }
    }
}

/// One value for all cells, and one for each class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ByClass<T> {
    /// All cells.
    pub all: T,
    /// Cells of coverage 0.
    pub free: T,
    /// Cells of a coverage between 0 and 1.
    pub partial: T,
    /// Cells of coverage 1.
    pub solid: T,
}

impl<T> ByClass<T> {
    /// The value of `f` for all cells (`None`) and for each class.
    pub fn from_fn(mut f: impl FnMut(Option<Class>) -> T) -> Self {
        Self {
            all: f(None),
            free: f(Some(Class::Free)),
            partial: f(Some(Class::Partial)),
            solid: f(Some(Class::Solid)),
        }
    }

    /// The value of all cells (`None`) or of a class.
    pub fn get(&self, class: Option<Class>) -> &T {
        match class {
            None => &self.all,
            Some(Class::Free) => &self.free,
            Some(Class::Partial) => &self.partial,
            Some(Class::Solid) => &self.solid,
        }
    }

    /// The value of a class.
    pub(crate) fn of_class_mut(&mut self, class: Class) -> &mut T {
        match class {
            Class::Free => &mut self.free,
            Class::Partial => &mut self.partial,
            Class::Solid => &mut self.solid,
        }
    }
}
