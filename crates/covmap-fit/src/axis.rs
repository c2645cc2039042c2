//! The free parameters, each with its bounds.

use covmap_model::{CauseParameters, FootprintRule, ModelParameters, ProductParameters, Update};
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

/// A parameter of the sensor model that can be fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Parameter {
    /// γ at distance and range 0, a density level.
    GammaBase,
    /// The slope of γ in the cell's distance \[1/m\].
    GammaPerCellDistance,
    /// The slope of γ in the range \[1/m\].
    GammaPerRange,
    /// σ_out at distance and range 0.
    SigmaOutBase,
    /// The slope of σ_out in the cell's distance \[1/m\].
    SigmaOutPerCellDistance,
    /// The slope of σ_out in the range \[1/m\].
    SigmaOutPerRange,
    /// σ_in.
    SigmaIn,
    /// Distance behind the end up to which cells are covered \[m\].
    Behind,
    /// The half-angle of the footprint \[rad\].
    HalfAngle,
    /// The usable range \[m\].
    UsableRange,
    /// Distance up to which no echo marks cells as free \[m\].
    NoEchoRange,
    /// γ of these cells.
    NoEchoGamma,
    /// The tempering exponent of Eq. (9).
    Tempering,
    /// τ of the update by cause \[m\].
    RangeTolerance,
    /// ℓ/r of the update by cause, in cells.
    CellDepth,
    /// Expected coverage of unknown cells.
    UnknownCoverage,
    /// p: exponent on the expected coverage of a surface that may have answered.
    Sharpness,
    /// a_0: weight of chance.
    Chance,
    /// κ: exponent on the clear part of the view.
    FirstEcho,
    /// σ_in of the update by cause at distance 0.
    EndSigmaBase,
    /// Its slope in the cell's distance \[1/m\].
    EndSigmaPerCellDistance,
    /// b: share of the cause that counts behind the end.
    BehindWeight,
    /// σ of "covered" behind the end.
    BehindSigma,
    /// f_0: share of "free" at the sensor.
    FreeShare,
    /// d_f: distance at which 1/e of it is left \[m\].
    FreeRange,
    /// Standard deviation of its decrease with the bearing, in half-widths.
    FreeWidth,
    /// σ of "free".
    FreeSigma,
    /// β: certainty that an echo from beyond the usable range passed.
    Beyond,
    /// ν: certainty that a beam without an echo passed.
    NoEchoShare,
    /// ρ_0: probability that a second reading from one place repeats the first.
    RepeatsShare,
    /// λ: distance over which readings share errors \[m\].
    RepeatsDistance,
}

impl Parameter {
    /// Returns the place of the parameter; `None` if the update has no such parameter.
    fn place(self, p: &mut ModelParameters) -> Option<&mut f64> {
        match (self, &mut p.update) {
            (Self::HalfAngle, _) => match &mut p.footprint {
                FootprintRule::Sectors { half_angle } | FootprintRule::Cones { half_angle } => {
                    Some(half_angle)
                }
            },
            (Self::UsableRange, _) => Some(&mut p.usable_range),
            (_, Update::Product(product)) => self.place_in_product(product),
            (_, Update::Cause(cause)) => self.place_in_cause(cause),
        }
    }

    fn place_in_product(self, p: &mut ProductParameters) -> Option<&mut f64> {
        Some(match self {
            Self::GammaBase => &mut p.gamma.base,
            Self::GammaPerCellDistance => &mut p.gamma.per_cell_distance,
            Self::GammaPerRange => &mut p.gamma.per_range,
            Self::SigmaOutBase => &mut p.sigma_out.base,
            Self::SigmaOutPerCellDistance => &mut p.sigma_out.per_cell_distance,
            Self::SigmaOutPerRange => &mut p.sigma_out.per_range,
            Self::SigmaIn => &mut p.sigma_in,
            Self::Behind => &mut p.behind,
            Self::NoEchoRange => &mut p.no_echo.range,
            Self::NoEchoGamma => &mut p.no_echo.gamma,
            Self::Tempering => &mut p.tempering,
            _ => return None,
        })
    }

    fn place_in_cause(self, p: &mut CauseParameters) -> Option<&mut f64> {
        Some(match self {
            Self::Behind => &mut p.behind,
            Self::NoEchoRange => &mut p.no_echo.range,
            Self::RangeTolerance => &mut p.range_tolerance,
            Self::CellDepth => &mut p.cell_depth,
            Self::UnknownCoverage => &mut p.unknown_coverage,
            Self::Sharpness => &mut p.sharpness,
            Self::Chance => &mut p.chance,
            Self::FirstEcho => &mut p.first_echo,
            Self::EndSigmaBase => &mut p.sigma_in.base,
            Self::EndSigmaPerCellDistance => &mut p.sigma_in.per_cell_distance,
            Self::BehindWeight => &mut p.behind_weight,
            Self::BehindSigma => &mut p.sigma_behind,
            Self::FreeShare => &mut p.free.share,
            Self::FreeRange => &mut p.free.range,
            Self::FreeWidth => &mut p.free.width,
            Self::FreeSigma => &mut p.free.sigma,
            Self::Beyond => &mut p.beyond,
            Self::NoEchoShare => &mut p.no_echo.share,
            Self::RepeatsShare => &mut p.repeats.share,
            Self::RepeatsDistance => &mut p.repeats.distance,
            _ => return None,
        })
    }

    /// Returns its value; `None` if the update has no such parameter.
    pub fn get(self, parameters: &ModelParameters) -> Option<f64> {
        self.place(&mut parameters.clone()).map(|value| *value)
    }

    /// Sets its value; does nothing if the update has no such parameter. The constructor of a model
    /// checks whether the parameters still make one.
    pub fn set(self, parameters: &mut ModelParameters, value: f64) {
        if let Some(place) = self.place(parameters) {
            *place = value;
        }
    }
}

/// A free parameter and the interval in which it is sought.
///
/// The search walks over \[0, 1\]. A `place` in it stands for the value `from + (to − from)·place`,
/// or, if `from` is above 0, for `from·(to/from)^place`: scales are sought in steps of a factor.
/// `P` is one of the sensor model's parameters, or of those of any method
/// ([`crate::MethodParameter`]).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis<P = Parameter> {
    /// The parameter.
    pub parameter: P,
    /// Its smallest value.
    pub from: f64,
    /// Its largest value.
    pub to: f64,
}

/// Error of an axis that cannot be searched.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AxisError<P: Debug = Parameter> {
    /// The bounds are no interval.
    #[error("{parameter:?}: from {from} and to {to} must be finite, from ≥ 0, and from < to")]
    Bounds {
        /// The parameter.
        parameter: P,
        /// Lower bound.
        from: f64,
        /// Upper bound.
        to: f64,
    },
    /// The model's update has no such parameter.
    #[error("{0:?} is no parameter of the model's update")]
    NotItsParameter(P),
    /// The parameter has two axes.
    #[error("{0:?} has two axes")]
    Twice(P),
}

impl<P: Copy + PartialEq + Debug> Axis<P> {
    /// Checks some axes.
    ///
    /// # Errors
    /// If bounds are no interval, or a parameter has two axes.
    pub fn check(axes: &[Self]) -> Result<(), AxisError<P>> {
        for (i, &Self { parameter, from, to }) in axes.iter().enumerate() {
            if !(from.is_finite() && to.is_finite() && 0.0 <= from && from < to) {
                return Err(AxisError::Bounds { parameter, from, to });
            }
            if axes[..i].iter().any(|other| other.parameter == parameter) {
                return Err(AxisError::Twice(parameter));
            }
        }
        Ok(())
    }

    /// Returns the value at a place in \[0, 1\].
    pub fn value(&self, place: f64) -> f64 {
        let Self { from, to, .. } = *self;
        let value = if from > 0.0 {
            from * libm::pow(to / from, place)
        } else {
            from + (to - from) * place
        };
        value.clamp(from, to)
    }

    /// Returns the place in \[0, 1\] of a value, which is moved into the bounds.
    pub fn place_of(&self, value: f64) -> f64 {
        let Self { from, to, .. } = *self;
        let value = value.clamp(from, to);
        let place = if from > 0.0 {
            libm::log(value / from) / libm::log(to / from)
        } else {
            (value - from) / (to - from)
        };
        place.clamp(0.0, 1.0)
    }
}

impl Axis {
    /// Returns the place in \[0, 1\] of the value that some parameters have.
    ///
    /// # Errors
    /// If their update has no such parameter.
    pub fn place(&self, parameters: &ModelParameters) -> Result<f64, AxisError> {
        let value = self.parameter.get(parameters);
        value.map(|value| self.place_of(value)).ok_or(AxisError::NotItsParameter(self.parameter))
    }

    /// Sets the parameter to the value at a place in \[0, 1\].
    pub fn set(&self, parameters: &mut ModelParameters, place: f64) {
        self.parameter.set(parameters, self.value(place));
    }
}

impl Axis {
    /// Returns the axes of the parameters of an update, but for those of the footprint, the usable
    /// range and repeated readings, each in a box that is wide enough for every fit so far.
    pub fn all_of(update: &Update) -> Vec<Self> {
        use Parameter as P;
        let axes: &[(P, f64, f64)] = match update {
            Update::Product(_) => &[
                (P::GammaBase, 0.001, 1.0),
                (P::GammaPerCellDistance, 0.001, 30.0),
                (P::GammaPerRange, 0.001, 30.0),
                (P::SigmaOutBase, 0.05, 0.25),
                (P::SigmaOutPerCellDistance, 0.0, 0.1),
                (P::SigmaOutPerRange, 0.0, 0.1),
                (P::SigmaIn, 0.06, 0.6),
                (P::Behind, 0.0, 0.4),
                (P::NoEchoRange, 0.1, 3.0),
                (P::NoEchoGamma, 0.05, 1000.0),
                (P::Tempering, 0.05, 1.0),
            ],
            Update::Cause(_) => &[
                (P::RangeTolerance, 0.005, 0.2),
                (P::CellDepth, 0.8, 2.0),
                (P::UnknownCoverage, 0.02, 1.0),
                (P::Sharpness, 0.05, 3.0),
                (P::Chance, 0.05, 50.0),
                (P::FirstEcho, 0.0, 12.0),
                (P::EndSigmaBase, 0.05, 0.6),
                (P::EndSigmaPerCellDistance, 0.0, 0.3),
                (P::Behind, 0.03, 0.6),
                (P::BehindWeight, 0.02, 1.0),
                (P::BehindSigma, 0.05, 1.0),
                (P::FreeShare, 0.02, 1.0),
                (P::FreeRange, 0.2, 6.0),
                (P::FreeWidth, 0.2, 5.0),
                (P::FreeSigma, 0.05, 0.3),
                (P::Beyond, 0.0, 1.0),
                (P::NoEchoRange, 0.1, 3.0),
                (P::NoEchoShare, 0.0, 1.0),
            ],
        };
        axes.iter().map(|&(parameter, from, to)| Self { parameter, from, to }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_set_is_found_again(place in 0.0..1.0f64, from in 0.0..0.5f64) {
            let axis = Axis { parameter: Parameter::NoEchoGamma, from, to: 2.0 };
            let mut parameters = ModelParameters::product();
            axis.set(&mut parameters, place);
            prop_assert!((axis.place(&parameters).unwrap() - place).abs() < 1e-9);
        }
    }

    #[test]
    fn every_parameter_is_another_one() {
        use Parameter as P;
        let shared = [P::Behind, P::HalfAngle, P::UsableRange, P::NoEchoRange];
        let product = [
            P::GammaBase,
            P::GammaPerCellDistance,
            P::GammaPerRange,
            P::SigmaOutBase,
            P::SigmaOutPerCellDistance,
            P::SigmaOutPerRange,
            P::SigmaIn,
            P::NoEchoGamma,
            P::Tempering,
        ];
        let cause = [
            P::RangeTolerance,
            P::CellDepth,
            P::UnknownCoverage,
            P::Sharpness,
            P::Chance,
            P::FirstEcho,
            P::EndSigmaBase,
            P::EndSigmaPerCellDistance,
            P::BehindWeight,
            P::BehindSigma,
            P::FreeShare,
            P::FreeRange,
            P::FreeWidth,
            P::FreeSigma,
            P::Beyond,
            P::NoEchoShare,
        ];
        for (mut parameters, own, foreign) in [
            (ModelParameters::product(), &product[..], &cause[..]),
            (ModelParameters::b21r(), &cause, &product),
        ] {
            let all = || shared.iter().chain(own);
            for (value, parameter) in (1..).zip(all()) {
                parameter.set(&mut parameters, f64::from(value));
            }
            for (value, parameter) in (1..).zip(all()) {
                assert_eq!(parameter.get(&parameters), Some(f64::from(value)), "{parameter:?}");
            }
            assert!(foreign.iter().all(|parameter| parameter.get(&parameters).is_none()));
        }
    }

    #[test]
    fn the_boxes_hold_what_is_shipped_and_name_each_parameter_once() {
        for parameters in [ModelParameters::product(), ModelParameters::b21r()] {
            let axes = Axis::all_of(&parameters.update);
            assert_eq!(Axis::check(&axes), Ok(()));
            for axis in axes {
                let value = axis.parameter.get(&parameters).unwrap();
                assert!((axis.from..=axis.to).contains(&value), "{axis:?} {value}");
            }
        }
    }

    #[test]
    fn impossible_axes_are_refused() {
        let axis = |from, to| Axis { parameter: Parameter::SigmaIn, from, to };
        assert!(Axis::check(&[axis(0.5, 0.1)]).is_err());
        assert!(Axis::check(&[axis(f64::NAN, 0.1)]).is_err());
        let twice = Axis::check(&[axis(0.1, 0.5), axis(0.1, 0.4)]);
        assert_eq!(twice, Err(AxisError::Twice(Parameter::SigmaIn)));
    }
}
