//! Values for all cells and for each class of them.

use covmap::Class;
use serde::{Deserialize, Serialize};

/// One value for all cells, and one for each class.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
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
    /// Creates the values of `f` for all cells (`None`) and for each class.
    pub fn from_fn(mut f: impl FnMut(Option<Class>) -> T) -> Self {
        Self {
            all: f(None),
            free: f(Some(Class::Free)),
            partial: f(Some(Class::Partial)),
            solid: f(Some(Class::Solid)),
        }
    }

    /// Returns the value of all cells (`None`) or of a class.
    pub fn get(&self, class: Option<Class>) -> &T {
        match class {
            None => &self.all,
            Some(Class::Free) => &self.free,
            Some(Class::Partial) => &self.partial,
            Some(Class::Solid) => &self.solid,
        }
    }

    /// Returns the value of a class.
    pub(crate) fn of_class_mut(&mut self, class: Class) -> &mut T {
        match class {
            Class::Free => &mut self.free,
            Class::Partial => &mut self.partial,
            Class::Solid => &mut self.solid,
        }
    }
}
