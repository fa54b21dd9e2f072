//! What a contact does in a step of the semismooth Newton method, and what of its reaction may change then.

use crate::law::NATURAL;
use crate::local::{Vector, tangential_norm};

/// What a contact does in one Newton step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Mode<const D: usize> {
    Free,
    Stick,
    Slip { along: Vector<D>, beta: f64 },
}

impl<const D: usize> Mode<D> {
    /// The mode by `z = r - v / w`. Beyond `mu = 1` the normal part takes `v_n / (mu w)`: there `mu r_n` is as large as
    /// `r_t`, and a velocity that is small beside it must not look like an endless friction force.
    #[inline]
    pub(crate) fn of(mu: f64, w: f64, r: &Vector<D>, v: &Vector<D>) -> Self {
        let mut z = r - v / w;
        if mu > NATURAL {
            z[D - 1] = r[D - 1] - v[D - 1] / (w * mu);
        }
        let (length, radius) = (tangential_norm(&z), mu * z[D - 1]);
        if z[D - 1] <= 0.0 {
            return Mode::Free;
        }
        if D == 1 || length <= radius && mu > 0.0 {
            return Mode::Stick;
        }
        let mut along = Vector::zeros();
        if length > 0.0 {
            for i in 0..D - 1 {
                along[i] = z[i] / length;
            }
        } else {
            along[0] = 1.0;
        }
        Mode::Slip {
            along,
            beta: if length > 0.0 { radius / length } else { 0.0 },
        }
    }

    /// Number of unknowns kept in the linear system.
    pub(crate) fn unknowns(&self) -> usize {
        match self {
            Mode::Free => 0,
            Mode::Stick => D,
            Mode::Slip { .. } => D - 1,
        }
    }

    /// Trial direction `k`: one in which the reaction of the contact may change.
    pub(crate) fn trial(&self, k: usize, mu: f64) -> Vector<D> {
        let mut x = Vector::zeros();
        match self {
            Mode::Slip { along, .. } if k == 0 => {
                x[D - 1] = 1.0;
                for i in 0..D - 1 {
                    x[i] = mu * along[i];
                }
            }
            Mode::Slip { along, .. } => x = across(along),
            _ => x[k] = 1.0,
        }
        x
    }

    /// Test direction `k`: the combination of the components of `dv` that is prescribed.
    pub(crate) fn test(&self, k: usize) -> Vector<D> {
        let mut y = Vector::zeros();
        match self {
            Mode::Slip { .. } if k == 0 => y[D - 1] = 1.0,
            Mode::Slip { along, beta } => {
                y = across(along) * *beta;
            }
            _ => y[k] = 1.0,
        }
        y
    }
}

/// The tangent across the slip direction.
pub(crate) fn across<const D: usize>(along: &Vector<D>) -> Vector<D> {
    let mut p = Vector::zeros();
    if D == 3 {
        p[0] = -along[1];
        p[1] = along[0];
    }
    p
}

/// `e.r_t - mu r_n`: how far a sliding contact is from its friction limit.
#[inline(always)]
pub(crate) fn slip_excess<const D: usize>(mu: f64, along: &Vector<D>, r: &Vector<D>) -> f64 {
    along.dot(r) - mu * r[D - 1]
}
