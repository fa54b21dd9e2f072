//! The error of a set of reactions, recomputed from nothing but the problem and `r`.

mod sums;

use crate::cone::Cone;
use crate::extended;
use crate::law::{ContactDiagnostic, diagnose, violation};
use crate::local::{Vector, from_spatial, load, spatial};
use crate::problem::ContactProblem;
use crate::rcc::{BondPoint, BondStep};

use sums::{EnergySums, PlainSums};

/// How far reactions are from solving a problem.
///
/// All but the first are sums over the contacts, with `r`, `u` and `q` of each brought to the square root of an energy
/// by its compliance `w_c` (mean diagonal of `W_cc`), `sqrt(w_c) r` and `u / sqrt(w_c)`. They do not depend on units,
/// and `r` stands in no denominator: reactions that run away make none of them small. Where the rounding of `W r` would
/// be seen in them, `u` is recomputed in twice the digits; for an operator, whose entries nobody knows, that rounding
/// is added.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Errors {
    /// `|F| / max(|q|, |r|, |u|)`, `F = r - Proj(r - (u + mu |u_t| n))` \[-\]: the measure of Siconos. It mixes units.
    /// Of a contact with `mu > 1` it takes `F / mu`, for `F` holds `mu` times the rounding of `|u_t|`.
    pub siconos: f64,
    /// `|F| / max(|q|, |u|)` in the energy norm \[-\]. Of a contact with `mu > 1` it takes the four parts below,
    /// together, instead of `F`, which falls as `1 / mu` there.
    pub scale_free: f64,
    /// Sum of bi-potential gaps over `|u| |r|` in the energy norm \[-\].
    pub gap: f64,
    /// Where `u_n < 0`: `|u_n| / max(|q|, |u|)` \[-\].
    pub penetration: f64,
    /// How far `r` is outside of the cone, by a pull or by friction above its limit, over `max(|q|, |u|)` \[-\].
    pub cone: f64,
    /// `min(r_n, u_n)` where both are positive, over `max(|q|, |u|)` \[-\].
    pub complementarity: f64,
    /// How far friction is from its value against the slip, `r_t - Proj(r_t - u_t)` on the disc of radius `mu r_n`,
    /// over `max(|q|, |u|)` \[-\].
    pub slip: f64,
}

impl Errors {
    /// The error of something that is no candidate at all.
    pub(crate) const WORST: Errors = Errors {
        siconos: f64::MAX,
        scale_free: f64::MAX,
        gap: f64::MAX,
        penetration: f64::MAX,
        cone: f64::MAX,
        complementarity: f64::MAX,
        slip: f64::MAX,
    };

    /// The error that a solution is judged by \[-\]: the largest of all but the gap.
    #[must_use]
    pub fn worst(&self) -> f64 {
        let parts = self.parts().into_iter().map(|(_, value)| value);
        parts.fold(self.siconos.max(self.scale_free), f64::max)
    }

    /// The parts of the law with their names \[-\].
    #[must_use]
    pub fn parts(&self) -> [(&'static str, f64); 4] {
        [
            ("penetration", self.penetration),
            ("cone slack", self.cone),
            ("complementarity", self.complementarity),
            ("slip misalignment", self.slip),
        ]
    }
}

/// A problem with the scales its errors are measured by.
///
/// ```
/// use contact_bipotential::{Cone, ContactProblem, Delassus, ErrorMeasure, Status};
///
/// // One contact in the plane, (t, n), that is pressed by 1 and dragged along by 10: it slides.
/// let w = Delassus::from_entries(1, 2, &[(0, 0, 2.0), (1, 1, 1.0)])?;
/// let problem = ContactProblem::new(w, vec![10.0, -1.0], vec![0.3], Cone::Planar)?;
/// let measure = ErrorMeasure::new(&problem);
/// let (mut u, r) = ([0.0; 2], [-0.3, 1.0]);
/// assert!(measure.evaluate(&r, &mut u).worst() < 1e-15);
/// assert_eq!(measure.diagnose(&r, &u)[0].status, Status::Slip);
/// # Ok::<(), contact_bipotential::ContactError>(())
/// ```
#[derive(Debug)]
pub struct ErrorMeasure<'a> {
    problem: &'a ContactProblem,
    bonds: &'a [BondStep],
    scales: Vec<f64>,
    /// Square roots of the scales.
    roots: Vec<f64>,
}

/// A contact whose bond has been taken off.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dry<const D: usize> {
    /// Friction coefficient at the intensity of the bond.
    pub(crate) mu: f64,
    /// Its derivative with respect to the intensity.
    pub(crate) mu_slope: f64,
    /// The part of the reaction that the contact law governs.
    pub(crate) r: Vector<D>,
    /// What the bond adds.
    pub(crate) bond: BondPoint,
}

impl<const D: usize> Dry<D> {
    /// A contact of the bare surfaces' friction `mu` with the whole reaction `r`; `u` is the end position of the bond's
    /// step.
    #[inline(always)]
    fn new(bond: Option<&BondStep>, mu: f64, r: &Vector<D>, u: &Vector<D>) -> Self {
        let Some(bond) = bond else {
            return Dry {
                mu,
                mu_slope: 0.0,
                r: *r,
                bond: BondPoint::default(),
            };
        };
        let at = bond.at(&spatial(u));
        Dry {
            mu: bond.friction(mu, at.intensity),
            mu_slope: bond.friction_slope(mu),
            r: r - from_spatial(&at.force),
            bond: at,
        }
    }
}

/// How far one contact is from the law, in the unit of `r`, zero exactly where the law holds:
/// `|r - Proj_K(r - rho (u + mu |u_t| n))|`. Beyond `mu = 1` this would fade where a contact penetrates, and the length
/// of penetration, cone slack, complementarity and slip misalignment stands for it, velocities times `rho`.
///
/// `u` and `r` are slices of `cone.dim()` entries, normal last; `rho > 0` is a stiffness, unit of `r` over unit of `u`.
/// With a `bond`, `u` is the end position of its step, and the law governs what the bond force leaves of `r`; `mu` is
/// that of the bare surfaces.
#[must_use]
pub fn law_residual(
    cone: Cone,
    bond: Option<&BondStep>,
    mu: f64,
    rho: f64,
    u: &[f64],
    r: &[f64],
) -> f64 {
    fn with<const D: usize>(
        bond: Option<&BondStep>,
        mu: f64,
        rho: f64,
        u: &[f64],
        r: &[f64],
    ) -> f64 {
        let u = load::<D>(u, 0);
        let dry = Dry::new(bond, mu, &load(r, 0), &u);
        violation(dry.mu, &(u * rho), &dry.r)
    }
    match cone {
        Cone::Frictionless => with::<1>(bond, mu, rho, u, r),
        Cone::Planar => with::<2>(bond, mu, rho, u, r),
        Cone::Spatial => with::<3>(bond, mu, rho, u, r),
    }
}

impl<'a> ErrorMeasure<'a> {
    /// Prepares the scales.
    #[must_use]
    pub fn new(problem: &'a ContactProblem) -> Self {
        Self::bonded(problem, &[])
    }

    /// The same with a bond at each contact (none at all if `bonds` is empty): `r` is the whole reaction, `u` is read
    /// as the end position `(dx_t, x_n)`, and the law governs what is left of `r` without the bond force.
    #[must_use]
    pub fn bonded(problem: &'a ContactProblem, bonds: &'a [BondStep]) -> Self {
        let scales = problem.compliance_scales();
        let roots = scales.iter().map(|w| w.sqrt()).collect();
        ErrorMeasure {
            problem,
            bonds,
            scales,
            roots,
        }
    }

    /// Contact `c` without its bond, which is there only where bonds were given.
    #[inline(always)]
    pub(crate) fn dry<const D: usize>(&self, c: usize, r: &Vector<D>, u: &Vector<D>) -> Dry<D> {
        Dry::new(self.bonds.get(c), self.problem.mu[c], r, u)
    }

    /// The bonds, one a contact, or none.
    pub(crate) fn bonds(&self) -> &'a [BondStep] {
        self.bonds
    }

    /// Compliance scale `w_c` of each contact, unit of `u` over unit of `r`.
    pub(crate) fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// Square roots of the scales: `sqrt(w_c) r` and `u / sqrt(w_c)` have the unit of a square root of an energy.
    pub(crate) fn roots(&self) -> &[f64] {
        &self.roots
    }

    /// Fills `u = W r + q` and measures the errors, in twice the digits where rounding would be seen in them.
    pub fn evaluate(&self, r: &[f64], u: &mut [f64]) -> Errors {
        self.velocity(r, u);
        let (errors, rounding) = self.errors_and_rounding(r, u);
        if rounding < ROUNDING_SEEN || errors.worst() > ROUNDING_RULES * rounding {
            return errors;
        }
        if extended::velocity(&self.problem.w, r, &self.problem.q, u) {
            return self.errors(r, u);
        }
        Errors {
            scale_free: errors.scale_free + rounding,
            ..errors
        }
    }

    /// The errors by which success is claimed: as [`Self::evaluate`], but where they are within the `tolerance`, and
    /// the rounding of `W r` by the entries of `W` may be a part of it, `u` is always summed in twice the digits.
    pub(crate) fn certify(&self, r: &[f64], u: &mut [f64], tolerance: f64) -> Errors {
        let errors = self.evaluate(r, u);
        if errors.worst() > tolerance {
            return errors;
        }
        let mut sums = vec![0.0; u.len()];
        if !extended::absolute(&self.problem.w, r, &self.problem.q, &mut sums) {
            return errors;
        }
        let d = self.problem.cone.dim();
        let largest = |v: &[f64]| {
            let scaled = v.iter().enumerate().map(|(i, v)| v / self.roots[i / d]);
            scaled.fold(0.0, |m, v| f64::max(m, v.abs()))
        };
        let (all, moved) = (largest(&sums), largest(u).max(largest(&self.problem.q)));
        let seen = ROUNDINGS * f64::EPSILON * all > CLAIMED * tolerance * moved;
        if seen && extended::velocity(&self.problem.w, r, &self.problem.q, u) {
            return self.errors(r, u);
        }
        errors
    }

    /// `u = W r + q`.
    pub fn velocity(&self, r: &[f64], u: &mut [f64]) {
        self.problem.w.times(r, u);
        for (u, q) in u.iter_mut().zip(&self.problem.q) {
            *u += q;
        }
    }

    /// The errors of `r` with a `u` known to belong to it.
    #[must_use]
    pub fn errors(&self, r: &[f64], u: &[f64]) -> Errors {
        self.errors_and_rounding(r, u).0
    }

    /// The errors, and what the rounding of `W r` may have added to them \[-\].
    fn errors_and_rounding(&self, r: &[f64], u: &[f64]) -> (Errors, f64) {
        match self.problem.cone {
            Cone::Frictionless => self.errors_with::<1>(r, u),
            Cone::Planar => self.errors_with::<2>(r, u),
            Cone::Spatial => self.errors_with::<3>(r, u),
        }
    }

    fn errors_with<const D: usize>(&self, r: &[f64], u: &[f64]) -> (Errors, f64) {
        // Brought to order one first: squares of any admissible number then neither overflow nor all vanish.
        let Some((plain, energy)) = self.magnitudes::<D>(r, u) else {
            return (Errors::WORST, 0.0);
        };
        let (k, e) = (reciprocal(plain), reciprocal(energy));
        let (mut raw, mut free) = (PlainSums::default(), EnergySums::default());
        for c in 0..self.problem.contacts() {
            let root = self.roots[c];
            let (uc, qc) = (load::<D>(u, c), load::<D>(&self.problem.q, c));
            let rc = load::<D>(r, c);
            let dry = self.dry(c, &rc, &uc);
            raw.add(dry.mu, &(dry.r * k), &(uc * k), &(qc * k));
            raw.add_whole(&(rc * k));
            let (up, down) = (e * root, e / root);
            free.add(dry.mu, &(dry.r * up), &(uc * down), &(qc * down));
            free.add_whole(&(rc * up));
        }
        let errors = free.errors(raw.error());
        if errors.worst().is_finite() {
            (errors, free.rounding())
        } else {
            (Errors::WORST, 0.0)
        }
    }

    /// Largest entry of `r`, `u` and `q`, and of `u` and `q` alone (of `r` if these vanish) in the energy norm; `None`
    /// where something is not finite.
    fn magnitudes<const D: usize>(&self, r: &[f64], u: &[f64]) -> Option<(f64, f64)> {
        let (mut plain, mut pushed, mut moved, mut sum) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0);
        for (c, root) in self.roots.iter().enumerate() {
            let (rc, uc, qc) = (
                load::<D>(r, c),
                load::<D>(u, c),
                load::<D>(&self.problem.q, c),
            );
            let (mr, mv) = (rc.amax(), uc.amax().max(qc.amax()));
            plain = plain.max(mr).max(mv);
            pushed = pushed.max(mr * root);
            moved = moved.max(mv / root);
            // `max` forgets NaN, a sum does not.
            for i in 0..D {
                sum += rc[i] * 0.0 + uc[i] * 0.0;
            }
        }
        let finite = (plain + pushed + moved + sum).is_finite();
        finite.then_some((plain, if moved > 0.0 { moved } else { pushed }))
    }

    /// How each contact stands with the law.
    #[must_use]
    pub fn diagnose(&self, r: &[f64], u: &[f64]) -> Vec<ContactDiagnostic> {
        match self.problem.cone {
            Cone::Frictionless => self.diagnose_with::<1>(r, u),
            Cone::Planar => self.diagnose_with::<2>(r, u),
            Cone::Spatial => self.diagnose_with::<3>(r, u),
        }
    }

    fn diagnose_with<const D: usize>(&self, r: &[f64], u: &[f64]) -> Vec<ContactDiagnostic> {
        let (_, energy) = self.magnitudes::<D>(r, u).unwrap_or_default();
        let e = reciprocal(energy);
        let (mut moved, mut free) = (0.0, 0.0);
        for (c, root) in self.roots.iter().enumerate() {
            let (uc, qc) = (load::<D>(u, c), load::<D>(&self.problem.q, c));
            moved += (uc * (e / root)).norm_squared();
            free += (qc * (e / root)).norm_squared();
        }
        let size = f64::max(moved, free);
        let size = if size > 0.0 { size.sqrt() } else { 1.0 };
        let one = |c: usize| {
            let (root, uc) = (self.roots[c], load::<D>(u, c));
            let Dry { mu, r: rc, .. } = self.dry(c, &load::<D>(r, c), &uc);
            ContactDiagnostic {
                error: violation(mu, &(uc * (e / root)), &(rc * (e * root))) / size,
                ..diagnose(mu, 1.0 / self.scales[c], &uc, &rc)
            }
        };
        (0..self.scales.len()).map(one).collect()
    }
}

/// The errors of `r`, everything recomputed. For many evaluations keep an [`ErrorMeasure`].
#[must_use]
pub fn errors(problem: &ContactProblem, r: &[f64]) -> Errors {
    let mut u = vec![0.0; problem.q.len()];
    if r.len() != u.len() {
        return Errors::WORST;
    }
    ErrorMeasure::new(problem).evaluate(r, &mut u)
}

/// Roundings of the largest sum `|W| |r| + |q|` that one entry of `u` has, in a long sum.
const ROUNDINGS: f64 = 16.0;
/// Part of the tolerance that they may take without being looked at \[-\].
const CLAIMED: f64 = 0.1;
/// Rounding over `max(|q|, |u|)` from which on it is looked at \[-\].
const ROUNDING_SEEN: f64 = 1e-13;
/// Error over the rounding in it beyond which the error is known well enough \[-\].
const ROUNDING_RULES: f64 = 100.0;

/// Exponents of two between which a power of two and its inverse are normal numbers, with some room for products.
const LARGEST_EXPONENT: f64 = 1000.0;

/// A power of two near `1 / size`, so that scaling rounds nothing.
fn reciprocal(size: f64) -> f64 {
    if size <= 0.0 || size.is_nan() {
        return 1.0;
    }
    (-size.log2().round())
        .clamp(-LARGEST_EXPONENT, LARGEST_EXPONENT)
        .exp2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::delassus::Delassus;
    use crate::law::Status;
    use faer::Mat;

    fn sliding_block(factor_w: f64, factor_q: f64) -> (ContactProblem, Vec<f64>) {
        let w = Mat::from_fn(3, 3, |i, j| if i == j { 2.0 * factor_w } else { 0.0 });
        let q = vec![3.0 * factor_q, 4.0 * factor_q, -2.0 * factor_q];
        let p = ContactProblem::new(Delassus::Dense(w), q, vec![0.5], Cone::Spatial).unwrap();
        let s = factor_q / factor_w;
        (p, vec![-0.3 * s, -0.4 * s, s])
    }

    #[test]
    fn exact_solution_has_no_error_in_any_unit() {
        for factor_w in [1e-150, 1e-6, 1.0, 1e6, 1e150] {
            for factor_q in [1e-150, 1.0, 1e150] {
                if factor_q / factor_w > 1e200 || factor_w / factor_q > 1e200 {
                    continue;
                }
                let (p, r) = sliding_block(factor_w, factor_q);
                let e = errors(&p, &r);
                assert!(
                    e.worst() < 1e-14 && e.gap < 1e-14,
                    "{factor_w} {factor_q} {e:?}"
                );
                let half: Vec<f64> = r.iter().map(|x| 0.5 * x).collect();
                let wrong = errors(&p, &half).scale_free;
                let (p1, r1) = sliding_block(1.0, 1.0);
                let half: Vec<f64> = r1.iter().map(|x| 0.5 * x).collect();
                assert!((wrong - errors(&p1, &half).scale_free).abs() < 1e-14);
                assert!(wrong > 0.1);
            }
        }
    }

    #[test]
    fn what_is_not_a_number_is_never_small() {
        let (p, mut r) = sliding_block(1.0, 1.0);
        r[1] = f64::NAN;
        assert_eq!(errors(&p, &r), Errors::WORST);
        assert_eq!(errors(&p, &[0.0]), Errors::WORST);
    }

    #[test]
    fn diagnostics_share_out_the_error() {
        let (p, r) = sliding_block(1.0, 1.0);
        let measure = ErrorMeasure::new(&p);
        let mut u = vec![0.0; 3];
        let half: Vec<f64> = r.iter().map(|x| 0.5 * x).collect();
        let e = measure.evaluate(&half, &mut u);
        let d = measure.diagnose(&half, &u);
        assert!(
            d[0].penetration > 0.9
                && d[0].error > 0.5 * e.scale_free
                && d[0].error < 2.0 * e.scale_free
        );
        measure.evaluate(&r, &mut u);
        assert_eq!(measure.diagnose(&r, &u)[0].status, Status::Slip);
    }
}
