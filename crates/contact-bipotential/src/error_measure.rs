//! The error of a set of reactions, recomputed from nothing but the problem and `r`.

use crate::cone::{Cone, bipotential_gap};
use crate::law::{ContactDiagnostic, diagnose, natural_map};
use crate::local::{Vector, from_spatial, load, spatial};
use crate::problem::ContactProblem;
use crate::rcc::{BondPoint, BondStep};

/// How far reactions are from solving a problem.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Errors {
    /// `|F| / max(|q|, |r|, |u|)`, `F = r - Proj(r - (u + mu |u_t| n))` \[-\]: the measure of Siconos. It mixes units.
    pub siconos: f64,
    /// `|F| / max(|q|, |u|)` with `r`, `u` and `q` of each contact brought to the square root of an energy by its
    /// compliance `w_c` (mean diagonal of `W_cc`): `sqrt(w_c) r`, `u / sqrt(w_c)` \[-\]. It does not depend on units,
    /// and reactions that run away in a problem without solution do not make it small. Only where `F` is as small as
    /// the rounding of `W r` makes it anyway does `|r|` count in the denominator.
    pub scale_free: f64,
    /// Sum of bi-potential gaps over `|u| |r|` in the same energy norm \[-\].
    pub gap: f64,
}

impl Errors {
    /// The error of something that is no candidate at all.
    pub(crate) const WORST: Errors = Errors {
        siconos: f64::MAX,
        scale_free: f64::MAX,
        gap: f64::MAX,
    };

    /// The larger of the two errors that a solution is judged by \[-\].
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.siconos.max(self.scale_free)
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

/// How far one contact is from the law: `|r - Proj_K(r - rho (u + mu |u_t| n))|`, in the unit of `r`, zero exactly
/// where the law holds.
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
        natural_map(dry.mu, rho, &u, &dry.r).norm()
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

    /// Fills `u = W r + q` and measures the errors.
    pub fn evaluate(&self, r: &[f64], u: &mut [f64]) -> Errors {
        self.velocity(r, u);
        self.errors(r, u)
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
        match self.problem.cone {
            Cone::Frictionless => self.errors_with::<1>(r, u),
            Cone::Planar => self.errors_with::<2>(r, u),
            Cone::Spatial => self.errors_with::<3>(r, u),
        }
    }

    fn errors_with<const D: usize>(&self, r: &[f64], u: &[f64]) -> Errors {
        // Brought to order one first: squares of any admissible number then neither overflow nor all vanish.
        let (plain, energy) = self.magnitudes::<D>(r, u);
        if !plain.is_finite() || !energy.is_finite() {
            return Errors::WORST;
        }
        let (k, e) = (reciprocal(plain), reciprocal(energy));
        let mut raw = Sums::default();
        let mut free = Sums::default();
        for c in 0..self.problem.contacts() {
            let root = self.roots[c];
            let (uc, qc) = (load::<D>(u, c), load::<D>(&self.problem.q, c));
            let rc = load::<D>(r, c);
            let dry = self.dry(c, &rc, &uc);
            for (sums, up, down) in [(&mut raw, k, k), (&mut free, e * root, e / root)] {
                sums.add(dry.mu, &(dry.r * up), &(uc * down), &(qc * down));
                sums.add_whole(&(rc * up));
            }
        }
        let errors = Errors {
            siconos: raw.error(),
            scale_free: free.strict_error(),
            gap: free.gap(),
        };
        if errors.worst().is_finite() {
            errors
        } else {
            Errors::WORST
        }
    }

    fn magnitudes<const D: usize>(&self, r: &[f64], u: &[f64]) -> (f64, f64) {
        let (mut plain, mut energy, mut sum) = (0.0_f64, 0.0_f64, 0.0);
        for (c, root) in self.roots.iter().enumerate() {
            let (rc, uc, qc) = (
                load::<D>(r, c),
                load::<D>(u, c),
                load::<D>(&self.problem.q, c),
            );
            let (mr, mv) = (rc.amax(), uc.amax().max(qc.amax()));
            plain = plain.max(mr).max(mv);
            energy = energy.max(mr * root).max(mv / root);
            // `max` forgets NaN, a sum does not.
            for i in 0..D {
                sum += rc[i] * 0.0 + uc[i] * 0.0;
            }
        }
        (plain + sum, energy + sum)
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
        let (_, energy) = self.magnitudes::<D>(r, u);
        let e = reciprocal(energy);
        let mut total = 0.0;
        for c in 0..self.scales.len() {
            let root = self.roots[c];
            let (rc, uc, qc) = (
                load::<D>(r, c),
                load::<D>(u, c),
                load::<D>(&self.problem.q, c),
            );
            let size = [rc * (e * root), uc * (e / root), qc * (e / root)];
            total += size.iter().map(|v| v.dot(v)).fold(0.0, f64::max);
        }
        let total = if total > 0.0 { total.sqrt() } else { 1.0 };
        let one = |c: usize| {
            let (root, uc) = (self.roots[c], load::<D>(u, c));
            let Dry { mu, r: rc, .. } = self.dry(c, &load::<D>(r, c), &uc);
            let f = natural_map(mu, 1.0, &(uc * (e / root)), &(rc * (e * root)));
            ContactDiagnostic {
                error: f.norm() / total,
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

/// Share of `|r|` that the rounding of `W r` may leave in `F` \[-\]: some fifty roundings.
const ROUNDING: f64 = 1e-14;
/// `|r|` over `|q|` in the energy norm beyond which reactions are not large but running away \[-\].
const RUNAWAY: f64 = 1e10;

#[derive(Default)]
struct Sums {
    f: f64,
    r: f64,
    u: f64,
    q: f64,
    gap: f64,
}

impl Sums {
    #[inline(always)]
    fn add<const D: usize>(&mut self, mu: f64, r: &Vector<D>, u: &Vector<D>, q: &Vector<D>) {
        let f = natural_map(mu, 1.0, u, r);
        self.f += f.dot(&f);
        self.u += u.dot(u);
        self.q += q.dot(q);
        self.gap += bipotential_gap(mu, u, r).abs();
    }

    /// The whole reaction, bond and all: what `F` was rounded with.
    #[inline(always)]
    fn add_whole<const D: usize>(&mut self, r: &Vector<D>) {
        self.r += r.dot(r);
    }

    fn error(&self) -> f64 {
        let size = self.q.max(self.r).max(self.u);
        if size > 0.0 {
            (self.f / size).sqrt()
        } else {
            0.0
        }
    }

    fn strict_error(&self) -> f64 {
        let size = self.q.max(self.u);
        let rounding = self.f <= ROUNDING * ROUNDING * self.r && self.r <= RUNAWAY * RUNAWAY * size;
        if rounding || size == 0.0 {
            return self.error();
        }
        (self.f / size).sqrt()
    }

    fn gap(&self) -> f64 {
        let size = (self.u * self.r).sqrt();
        if size > 0.0 { self.gap / size } else { 0.0 }
    }
}

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
