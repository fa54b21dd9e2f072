//! Adhesion that breaks and heals: the law of Raous, Cangemi and Cocou at one contact node \[Raous1999, Hu2022\].
//!
//! Free energy `beta^2 k / 2 - w beta` and viscous dissipation `b beta'^2` per area, with
//! `k = C_n x_n^2 + C_t |u_t|^2`: the bond pulls with `-beta^2 (C_t u_t, C_n x_n)`, and `b beta' = w - k beta` within
//! `0 <= beta <= 1`. `u_t` is the separation since bonding, `x_n` the gap. Everything here is pure: a [`BondStep`] is
//! asked as often as an iteration likes and changes nothing.

mod parameters;
mod update;

use nalgebra::{Matrix3, Vector3};

pub use parameters::{Adhesion, DEFAULT_THRESHOLD, Healing, Reference, Update};
use update::{blend, blend_slope, decay_mean, decay_mean_slope};

/// Gap over the damage gap \[-\] up to which a pair counts as touching: its bond is strained by a millionth of `w`. An
/// iteration that approaches a closed gap from above must not see healing come and go with the last digits.
const CLOSED: f64 = 1e-3;

/// Share of its intensity \[-\] that a bond may lose in a step that is believed although the end might be another one.
const CONTINUED: f64 = 0.2;

/// Steepest fall of the pull `beta^2 C x` with the stretch `x` over its secant `beta^2 C` \[-\]. Over a step the slope
/// is `beta^2 C (1 - 4 k / (b / dt + k))`: it falls where `3 k dt > b`, and three times the secant is the limit.
const SOFTENING: f64 = 3.0;

/// Pull over the strength of a bond below which it is not worth following \[-\].
const WEAK: f64 = 1e-3;

/// The bond of a slave node between two steps.
///
/// ```
/// use contact_bipotential::nalgebra::Vector3;
/// use contact_bipotential::{Adhesion, Bond, BondStep};
///
/// # fn main() -> Result<(), contact_bipotential::ParameterError> {
/// let law = Adhesion::new(2e9, 1.5e9, 20.0, 0.1).validated()?;
/// let (area, dt) = (1e-4, 1e-3);
/// // A millisecond in which an intact bond is pulled to three times the gap at which it starts to break.
/// let step = BondStep::new(&law, area, dt, Bond::new(1.0, 0.0, [0.0; 2]), 0.0);
/// let end = Vector3::new(0.0, 0.0, 3.0 * law.damage_gap());
/// assert!(step.at(&end).force.z < 0.0);
/// assert!(step.finish(&end).intensity < 1.0);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Bond {
    /// `beta` \[-\], 0 broken, 1 intact.
    pub intensity: f64,
    /// `x_n`, not negative \[m\].
    pub gap: f64,
    /// `u_t` along `t1` and `t2` \[m\].
    pub separation: [f64; 2],
}

impl Bond {
    /// A bond of `intensity` \[-\] at the `gap` \[m\] with the tangential `separation` \[m\].
    #[must_use]
    pub const fn new(intensity: f64, gap: f64, separation: [f64; 2]) -> Self {
        Self {
            intensity,
            gap,
            separation,
        }
    }

    /// Whether the bond is worth following: not broken, and pulling with a thousandth of its strength `s0 = sqrt(w C)`
    /// or more. What is left of the work of separation then is `w/200` at most in slow separation.
    #[must_use]
    pub fn holds(&self, law: &Adhesion) -> bool {
        let [t1, t2] = law.tangential_stiffness;
        let [u1, u2] = self.separation;
        let pull =
            (law.normal_stiffness * self.gap).powi(2) + (t1 * u1).powi(2) + (t2 * u2).powi(2);
        let strength = (law.energy * t1.max(t2).max(law.normal_stiffness)).sqrt();
        let beta = self.intensity;
        beta > law.threshold && (self.gap == 0.0 || beta * beta * pull.sqrt() > WEAK * strength)
    }

    /// Free energy of the bond \[J\] on an area \[m^2\].
    #[must_use]
    pub fn energy(&self, law: &Adhesion, area: f64) -> f64 {
        let (beta, k) = (self.intensity, law.strain(&self.separation, self.gap));
        area * beta * (0.5 * beta * k - law.energy)
    }
}

/// One bond over one step: all that is known before the end position is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondStep {
    law: Adhesion,
    area: f64,
    dt: f64,
    start: Bond,
    /// Gap up to which a pair counts as touching \[m\].
    touching: f64,
    /// Share of the separation that ageing leaves.
    kept: f64,
}

/// A bond at one end position of a step; local axes `(t1, t2, n)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BondPoint {
    /// `beta` at the end \[-\].
    pub intensity: f64,
    /// Bond force on the slave \[N\]: it pulls the slave back.
    pub force: Vector3<f64>,
    /// Minus the derivative of the force with respect to `(dx_t, x_n)` \[N/m\]; not symmetric, may be indefinite where
    /// the bond softens.
    pub stiffness: Matrix3<f64>,
    /// Derivative of `beta` with respect to `(dx_t, x_n)` \[1/m\].
    pub intensity_slope: Vector3<f64>,
}

/// Energies of a bond over one step \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BondEnergy {
    /// Change of the free energy \[J\].
    pub stored: f64,
    /// Dissipated by breaking, healing and ageing \[J\], >= 0.
    pub dissipated: f64,
    /// Work that the bond force took over the step \[J\].
    pub work: f64,
}

impl BondStep {
    /// A step of `dt` \[s\] of a bond on an `area` \[m^2\]; `roundoff` is the error of a gap \[m\].
    #[must_use]
    pub fn new(law: &Adhesion, area: f64, dt: f64, start: Bond, roundoff: f64) -> Self {
        let touching = law.healing_gap + roundoff.max(CLOSED * law.damage_gap());
        let ages = law.reference == Reference::Ageing && start.gap <= touching;
        let formed = dt * law.energy;
        let old = law.viscosity * start.intensity;
        Self {
            law: *law,
            area,
            dt,
            start,
            touching,
            kept: if ages && formed > 0.0 {
                old / (old + formed)
            } else {
                1.0
            },
        }
    }

    /// A contact without adhesion.
    #[must_use]
    pub fn none() -> Self {
        Self::new(
            &Adhesion::new(0.0, 0.0, 0.0, 0.0),
            0.0,
            0.0,
            Bond::default(),
            0.0,
        )
    }

    /// The bond at the start of the step.
    #[must_use]
    pub fn start(&self) -> &Bond {
        &self.start
    }

    /// Whether a pair at the gap `x_n` \[m\] touches, so that bonds can form.
    #[must_use]
    pub fn touches(&self, gap: f64) -> bool {
        gap <= self.touching
    }

    /// Whether there is a bond at the start, or one may form at the gap `x_n` \[m\].
    #[must_use]
    pub fn may_act(&self, gap: f64) -> bool {
        self.area > 0.0
            && (self.start.intensity > 0.0
                || self.law.healing == Healing::Recoverable && self.touches(gap))
    }

    /// `mu` at the intensity `beta`, where `mu` is that of the bare surfaces \[-\].
    #[must_use]
    pub fn friction(&self, mu: f64, beta: f64) -> f64 {
        let bonded = self.law.bonded_friction.filter(|_| self.area > 0.0);
        bonded.map_or(mu, |bonded| mu + (bonded - mu) * beta)
    }

    /// Derivative of [`friction`](Self::friction) with respect to `beta`.
    pub(crate) fn friction_slope(&self, mu: f64) -> f64 {
        self.friction(mu, 1.0) - mu
    }

    /// `(u_t1, x_n)` at the end position `x = (dx_t, x_n)`.
    fn end(&self, x: &Vector3<f64>) -> ([f64; 2], f64) {
        let u = self.start.separation;
        let separation = [0, 1].map(|i| self.kept * (u[i] + x[i]));
        (separation, x[2].max(0.0))
    }

    /// The `k` that stands for the whole step, and its derivative with respect to that at the end.
    fn mean_strain(&self, x: &Vector3<f64>) -> (f64, f64) {
        let (separation, gap) = self.end(x);
        let k1 = self.law.strain(&separation, gap);
        let k0 = self.law.strain(&self.start.separation, self.start.gap);
        match self.law.update {
            Update::EnergyConsistent => (0.5 * (k0 + k1), 0.5),
            // A pair without bonds has no strained ones on its way into contact.
            Update::SecondOrder if self.start.intensity == 0.0 || self.law.viscosity == 0.0 => {
                (k1, 1.0)
            }
            Update::SecondOrder => {
                let rate = self.dt / self.law.viscosity;
                let (z, change) = (0.5 * rate * (k0 + k1), k1 - k0);
                let share = blend(z);
                let slope = share + 0.5 * rate * blend_slope(z) * change;
                (k0 + share * change, slope)
            }
        }
    }

    /// `beta` at the end position `x = (dx_t, x_n)` \[m\], and its derivative with respect to the `k` there.
    #[must_use]
    pub fn intensity(&self, x: &Vector3<f64>) -> (f64, f64) {
        let (start, law) = (self.start.intensity, &self.law);
        if self.area == 0.0 {
            return (0.0, 0.0);
        }
        let (k, k_slope) = self.mean_strain(x);
        let (free, slope) = match law.update {
            Update::EnergyConsistent => self.midpoint(k),
            Update::SecondOrder if law.viscosity == 0.0 => rate_independent(law.energy, k),
            Update::SecondOrder => self.exponential(k),
        };
        let heals = law.healing == Healing::Recoverable && self.touches(x[2]);
        let most = if heals { 1.0 } else { start };
        if free >= most {
            (most, 0.0)
        } else if free <= 0.0 {
            (0.0, 0.0)
        } else {
            (free, slope * k_slope)
        }
    }

    /// `beta0 e^-z + (w dt / b) (1 - e^-z) / z`, `z = k dt / b`, and its derivative with respect to `k`.
    fn exponential(&self, k: f64) -> (f64, f64) {
        let rate = self.dt / self.law.viscosity;
        let (z, source, start) = (k * rate, self.law.energy * rate, self.start.intensity);
        let decay = (-z).exp();
        let beta = start * decay + source * decay_mean(z);
        (beta, (source * decay_mean_slope(z) - start * decay) * rate)
    }

    /// `b (beta1 - beta0) / dt = w - k (beta0 + beta1) / 2`, and its derivative with respect to `k`.
    fn midpoint(&self, k: f64) -> (f64, f64) {
        let (b, start) = (self.law.viscosity / self.dt, self.start.intensity);
        let beta = ((b - 0.5 * k) * start + self.law.energy) / (b + 0.5 * k);
        (beta, -0.5 * (start + beta) / (b + 0.5 * k))
    }

    /// For the intensity `beta` at the end the force is `-D (x + shift)`: the diagonal `D` \[N/m\] and the shift \[m\]
    /// (`(I + W D)^-1 W` is then the compliance that friction sees). Valid for `x_n >= 0`.
    pub(crate) fn spring(&self, beta: f64) -> (Vector3<f64>, Vector3<f64>) {
        let [t1, t2] = self.law.tangential_stiffness;
        let c = Vector3::new(self.kept * t1, self.kept * t2, self.law.normal_stiffness);
        let (u, start) = (self.start.separation, self.start.intensity);
        match self.law.update {
            Update::SecondOrder => {
                let factor = self.area * beta * beta;
                (c * factor, Vector3::new(u[0], u[1], 0.0))
            }
            Update::EnergyConsistent => {
                let factor = 0.25 * self.area * (start * start + beta * beta);
                // Without anything kept the start has no separation either, and no stiffness that it would load.
                let back = if self.kept > 0.0 {
                    1.0 + 1.0 / self.kept
                } else {
                    0.0
                };
                let shift = Vector3::new(back * u[0], back * u[1], self.start.gap);
                (c * factor, shift)
            }
        }
    }

    /// The bond at the end position `x = (dx_t, x_n)` \[m\]. A penetration of an iterate counts as no gap.
    #[must_use]
    pub fn at(&self, x: &Vector3<f64>) -> BondPoint {
        let (intensity, slope) = self.intensity(x);
        let (mut d, shift) = self.spring(intensity);
        let per_square = self.spring_per_square();
        let (separation, gap) = self.end(x);
        let open = x[2] > 0.0;
        let stretch = Vector3::new(x[0], x[1], gap) + shift;
        let force = -d.component_mul(&stretch);
        if !open {
            d[2] = 0.0;
        }
        let [t1, t2] = self.law.tangential_stiffness;
        let k_slope = Vector3::new(
            2.0 * t1 * self.kept * separation[0],
            2.0 * t2 * self.kept * separation[1],
            2.0 * self.law.normal_stiffness * gap,
        );
        let intensity_slope = k_slope * slope;
        let softening = (per_square * (2.0 * intensity)).component_mul(&stretch);
        let stiffness = Matrix3::from_diagonal(&d) + softening * intensity_slope.transpose();
        BondPoint {
            intensity,
            force,
            stiffness,
            intensity_slope,
        }
    }

    /// Derivative of `D` with respect to `beta^2`.
    fn spring_per_square(&self) -> Vector3<f64> {
        self.spring(1.0).0 - self.spring(0.0).0
    }

    /// The bond after the step that ended at `x`; one that has parted and is weaker than the threshold is forgotten.
    #[must_use]
    pub fn finish(&self, x: &Vector3<f64>) -> Bond {
        let (separation, gap) = self.end(x);
        let intensity = self.intensity(x).0;
        if !self.touches(gap) && intensity < self.law.threshold {
            return Bond {
                gap,
                ..Bond::default()
            };
        }
        Bond {
            intensity,
            gap,
            separation,
        }
    }

    /// Energies of the step that ended at `x`. Work minus stored minus dissipated is the error of the integration: zero
    /// for [`Update::EnergyConsistent`] without ageing.
    #[must_use]
    pub fn energy(&self, x: &Vector3<f64>) -> BondEnergy {
        let (separation, gap) = self.end(x);
        let (b0, b1) = (self.start.intensity, self.intensity(x).0);
        let end = Bond {
            intensity: b1,
            gap,
            separation,
        };
        let (k, _) = self.mean_strain(x);
        // The integral of (w - k beta) d beta, whose integrand has the sign of d beta on the way.
        let broken = if self.law.viscosity > 0.0 {
            (b1 - b0) * (self.law.energy - 0.5 * k * (b1 + b0))
        } else {
            0.0
        };
        let stretched = [0, 1].map(|i| separation[i] / self.kept.max(f64::MIN_POSITIVE));
        let aged = self.law.strain(&stretched, gap) - self.law.strain(&separation, gap);
        let aged = if self.kept < 1.0 && self.kept > 0.0 {
            0.5 * b1 * b1 * aged
        } else {
            0.0
        };
        let force = self.at(x).force;
        let work = -(force[0] * x[0] + force[1] * x[1] + force[2] * (gap - self.start.gap));
        BondEnergy {
            stored: end.energy(&self.law, self.area) - self.start.energy(&self.law, self.area),
            dissipated: (self.area * (broken + aged)).max(0.0),
            work,
        }
    }

    /// Whether the step may have jumped: the bond lost a good part of its intensity, and more than one end position may
    /// satisfy the law, since it softens faster than both viscosity over `dt` and the body of local stiffness
    /// `stiffness` \[N/m\] can follow. A branch that goes on is told from a jump by steps so short that the bond loses
    /// little in each.
    #[must_use]
    pub fn may_snap(&self, x: &Vector3<f64>, stiffness: f64) -> bool {
        let (separation, gap) = self.end(x);
        let c = self
            .law
            .tangential_stiffness
            .iter()
            .fold(self.law.normal_stiffness, |m, c| m.max(*c));
        let b0 = self.start.intensity;
        self.intensity(x).0 < (1.0 - CONTINUED) * b0
            && SOFTENING * self.law.strain(&separation, gap) * self.dt > self.law.viscosity
            && SOFTENING * c * b0 * b0 * self.area > stiffness
    }
}

/// `min(1, w / k)` and its derivative.
fn rate_independent(w: f64, k: f64) -> (f64, f64) {
    if w >= k {
        (1.0, 0.0)
    } else {
        (w / k, -w / (k * k))
    }
}

#[cfg(test)]
mod tests;
