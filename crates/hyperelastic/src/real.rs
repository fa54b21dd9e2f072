//! The numbers an energy is computed with.

use std::ops::{Add, Div, Mul, Neg, Sub};

use nalgebra::Scalar;

/// A real number, or a number that carries derivatives along.
///
/// An energy written over `Real` is computed with `f64` in production, and with the dual numbers of
/// `num-dual` by the battery in `conformance`, which so obtains its derivatives without
/// using the law's own formulas for the stress and the tangent.
pub trait Real:
    Copy
    + Scalar
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// The value without its derivatives: the only part that branches may look at.
    fn re(self) -> f64;
    /// `sqrt(x)`.
    fn sqrt(self) -> Self;
    /// `ln(x)`.
    fn ln(self) -> Self;
    /// `ln(1 + x)`, exact to round-off for small `x`.
    fn ln_1p(self) -> Self;
    /// `e^x`.
    fn exp(self) -> Self;
    /// `x^p`.
    fn powf(self, p: f64) -> Self;
    /// `1/x`.
    fn recip(self) -> Self;
}

impl Real for f64 {
    #[inline]
    fn re(self) -> f64 {
        self
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline]
    fn ln_1p(self) -> Self {
        f64::ln_1p(self)
    }
    #[inline]
    fn exp(self) -> Self {
        f64::exp(self)
    }
    #[inline]
    fn powf(self, p: f64) -> Self {
        f64::powf(self, p)
    }
    #[inline]
    fn recip(self) -> Self {
        1.0 / self
    }
}

#[cfg(feature = "conformance")]
macro_rules! real_for_dual {
    ($($number:ty),+) => {$(
        impl Real for $number {
            fn re(self) -> f64 {
                self.re
            }
            fn sqrt(self) -> Self {
                num_dual::DualNum::sqrt(&self)
            }
            fn ln(self) -> Self {
                num_dual::DualNum::ln(&self)
            }
            fn ln_1p(self) -> Self {
                num_dual::DualNum::ln_1p(&self)
            }
            fn exp(self) -> Self {
                num_dual::DualNum::exp(&self)
            }
            fn powf(self, p: f64) -> Self {
                num_dual::DualNum::powf(&self, p)
            }
            fn recip(self) -> Self {
                num_dual::DualNum::recip(&self)
            }
        }
    )+};
}

#[cfg(feature = "conformance")]
real_for_dual!(num_dual::Dual64, num_dual::Dual2_64, num_dual::HyperDual64);
