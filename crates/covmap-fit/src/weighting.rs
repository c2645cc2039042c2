//! The weighting of cells in an objective.

use crate::{ByClass, Class, ExampleScore};
use serde::{Deserialize, Serialize};

/// Weighting of cells in the mean of the objective.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Weighting {
    /// All cells count alike.
    Cells,
    /// The classes count alike: cells that are free, partly covered, and solid, as far as there are
    /// any. Indoors most cells are free, and few are solid and in sight: if cells counted alike, a
    /// fit could buy a better likelihood of the others by forgetting walls.
    Classes,
}

impl Weighting {
    /// Returns the mean log-likelihood \[nats\].
    pub fn objective(self, score: &ExampleScore) -> f64 {
        let is_there = |class| score.get(Some(class)).cells > 0;
        let mean = self.mean(is_there, |class| Some(score.get(class).log_likelihood));
        mean.unwrap_or(0.0)
    }

    /// Returns the weight of each cell, by its class; the weights sum to 1.
    pub(crate) fn weights(
        self,
        cells: impl ExactSizeIterator<Item = Class> + Clone,
    ) -> impl Iterator<Item = f64> {
        let share = |count: usize| 1.0 / count.max(1) as f64;
        let of_class = ByClass::from_fn(|class| match (self, class) {
            (_, None) => 0.0,
            (Self::Cells, Some(_)) => share(cells.len()),
            (Self::Classes, Some(class)) => share(cells.clone().filter(|c| *c == class).count()),
        });
        let each = move |class| *of_class.get(Some(class));
        let total: f64 = cells.clone().map(each).sum();
        cells.map(move |class| each(class) / total)
    }

    /// Returns the mean of `of` over all cells (`None`) or over the classes that are there; `None`
    /// if `of` has no value for one of them, or there are none.
    pub(crate) fn mean(
        self,
        is_there: impl Fn(Class) -> bool,
        of: impl Fn(Option<Class>) -> Option<f64>,
    ) -> Option<f64> {
        match self {
            Self::Cells => of(None),
            Self::Classes => {
                let classes = [Class::Free, Class::Partial, Class::Solid].into_iter();
                let there = classes.filter(|class| is_there(*class)).map(Some);
                let means: Vec<f64> = there.map(of).collect::<Option<_>>()?;
                let mean = means.iter().sum::<f64>() / means.len() as f64;
                (!means.is_empty()).then_some(mean)
            }
        }
    }
}
