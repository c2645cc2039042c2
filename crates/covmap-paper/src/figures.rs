//! The figures of the paper, each from its own experiment; and those of `docs/gain.md`.

pub(crate) mod fig1;
pub(crate) mod fig2;
pub(crate) mod fig3;
pub(crate) mod fig5;
pub(crate) mod fig6;
pub(crate) mod fig7;
pub(crate) mod gain;
mod map_figure;
