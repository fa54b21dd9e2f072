//! Sums over the contacts from which the errors are taken.

use super::Errors;
use crate::cone::bipotential_gap;
use crate::law::{Breach, NATURAL, natural_map};
use crate::local::Vector;

/// Share of `|r|` in the energy norm that the rounding of `W r` may leave in an error \[-\]: some fifty roundings.
const ROUNDING: f64 = 1e-14;

/// Sums of squares in the units of the problem.
#[derive(Default)]
pub(super) struct PlainSums {
    f: f64,
    r: f64,
    u: f64,
    q: f64,
}

impl PlainSums {
    #[inline(always)]
    pub(super) fn add<const D: usize>(
        &mut self,
        mu: f64,
        r: &Vector<D>,
        u: &Vector<D>,
        q: &Vector<D>,
    ) {
        let f = natural_map(mu, 1.0, u, r) / mu.max(NATURAL);
        self.f += f.dot(&f);
        self.u += u.dot(u);
        self.q += q.dot(q);
    }

    /// The whole reaction, bond and all.
    #[inline(always)]
    pub(super) fn add_whole<const D: usize>(&mut self, r: &Vector<D>) {
        self.r += r.dot(r);
    }

    pub(super) fn error(&self) -> f64 {
        ratio(self.f, self.q.max(self.r).max(self.u))
    }
}

/// Sums of squares in the energy norm.
#[derive(Default)]
pub(super) struct EnergySums {
    f: f64,
    r: f64,
    u: f64,
    q: f64,
    gap: f64,
    penetration: f64,
    cone: f64,
    complementarity: f64,
    slip: f64,
}

impl EnergySums {
    #[inline(always)]
    pub(super) fn add<const D: usize>(
        &mut self,
        mu: f64,
        r: &Vector<D>,
        u: &Vector<D>,
        q: &Vector<D>,
    ) {
        let breach = Breach::of(mu, u, r);
        self.f += if mu <= NATURAL {
            let f = natural_map(mu, 1.0, u, r);
            f.dot(&f)
        } else {
            breach.square()
        };
        self.u += u.dot(u);
        self.q += q.dot(q);
        self.gap += bipotential_gap(mu, u, r).abs();
        self.penetration += breach.penetration * breach.penetration;
        self.cone += breach.cone * breach.cone;
        self.complementarity += breach.complementarity * breach.complementarity;
        self.slip += breach.slip * breach.slip;
    }

    /// The whole reaction, bond and all: what `u` was rounded with.
    #[inline(always)]
    pub(super) fn add_whole<const D: usize>(&mut self, r: &Vector<D>) {
        self.r += r.dot(r);
    }

    /// What the errors are divided by: where nothing moves, `r` alone can be wrong.
    fn size(&self) -> f64 {
        let moved = self.q.max(self.u);
        if moved > 0.0 { moved } else { self.r }
    }

    pub(super) fn errors(&self, siconos: f64) -> Errors {
        let size = self.size();
        let power = (self.u * self.r).sqrt();
        Errors {
            siconos,
            scale_free: ratio(self.f, size),
            gap: if power > 0.0 { self.gap / power } else { 0.0 },
            penetration: ratio(self.penetration, size),
            cone: ratio(self.cone, size),
            complementarity: ratio(self.complementarity, size),
            slip: ratio(self.slip, size),
        }
    }

    /// What the rounding of `W r` may have added \[-\].
    pub(super) fn rounding(&self) -> f64 {
        ROUNDING * ratio(self.r, self.size())
    }
}

/// Square root of a ratio of squares; nothing over nothing is nothing.
fn ratio(square: f64, size: f64) -> f64 {
    if size > 0.0 {
        (square / size).sqrt()
    } else {
        0.0
    }
}
