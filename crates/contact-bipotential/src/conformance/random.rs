//! Problems drawn from extremes: hyperstatic, unsymmetric, friction and units over many decades.

use faer::Mat;

use crate::cone::Cone;
use crate::delassus::Delassus;
use crate::problem::ContactProblem;

/// Contacts of a drawn problem at most.
const MOST_CONTACTS: u64 = 8;
/// Decades over which units spread to both sides \[-\].
const UNITS: f64 = 12.0;

/// A problem and, where it was made from one, a solution.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// The problem.
    pub problem: ContactProblem,
    /// Reactions that solve it up to the rounding of `q`, normal last.
    pub solution: Option<Vec<f64>>,
}

/// A sequence of draws that never changes (splitmix64).
struct Draws(u64);

impl Draws {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Between 0 and 1.
    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn decades(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(self.within(low, high))
    }

    fn below(&mut self, count: u64) -> u64 {
        self.bits() % count.max(1)
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }
}

/// Draw number `index` of the family with this `seed`.
///
/// 1 to 8 contacts; `W = A A^T` of rigid bodies (rank 6 or 12) or of any rank; every second one unsymmetric by 1e-6 to
/// 1e-1 of its diagonal; `mu` from 1e-2 to 1e6, sometimes 0; units of `W` and `q` from 1e-12 to 1e12; two thirds made
/// from a solution, the others with any `q`, so that they may have none.
#[must_use]
pub fn drawn_problem(seed: u64, index: u64) -> Drawn {
    let mut draws =
        Draws(seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ index.wrapping_mul(0xd134_2543_de82_ef95));
    let cone = match draws.below(8) {
        0 => Cone::Frictionless,
        1 | 2 => Cone::Planar,
        _ => Cone::Spatial,
    };
    let contacts = 1 + draws.below(MOST_CONTACTS) as usize;
    let size = contacts * cone.dim();
    let (w_unit, u_unit) = (draws.decades(-UNITS, UNITS), draws.decades(-UNITS, UNITS));
    let w = compliance(&mut draws, cone, contacts, w_unit);
    let mu = friction(&mut draws, contacts);
    let w = Delassus::Dense(w);
    let made = draws.chance(0.67);
    let mut q = vec![0.0; size];
    let mut solution = None;
    if made {
        let (r, u) = pair(&mut draws, cone, &mu);
        let r: Vec<f64> = r.iter().map(|r| r * (u_unit / w_unit)).collect();
        w.times(&r, &mut q);
        for (q, u) in q.iter_mut().zip(&u) {
            *q = u * u_unit - *q;
        }
        solution = Some(r);
    } else {
        for q in &mut q {
            *q = draws.within(-1.0, 1.0) * u_unit;
        }
    }
    let w = if draws.chance(0.3) {
        w.compressed(contacts, cone.dim())
    } else {
        w
    };
    Drawn {
        problem: ContactProblem::unchecked(w, q, mu, cone),
        solution,
    }
}

fn friction(draws: &mut Draws, contacts: usize) -> Vec<f64> {
    let one = |draws: &mut Draws| {
        if draws.chance(0.05) {
            0.0
        } else if draws.chance(0.5) {
            draws.within(0.05, 1.5)
        } else {
            draws.decades(-2.0, 6.0)
        }
    };
    let same = draws.chance(0.5).then(|| one(draws));
    (0..contacts)
        .map(|_| same.unwrap_or_else(|| one(draws)))
        .collect()
}

fn compliance(draws: &mut Draws, cone: Cone, contacts: usize, unit: f64) -> Mat<f64> {
    let size = contacts * cone.dim();
    let rank = if draws.chance(0.5) {
        6
    } else {
        1 + draws.below(size as u64 + 2) as usize
    };
    let sizes: Vec<f64> = (0..rank).map(|_| draws.decades(-0.5, 0.5)).collect();
    let a = Mat::from_fn(size, rank, |_, k| draws.within(-1.0, 1.0) * sizes[k]);
    let mut w = Mat::from_fn(size, size, |i, j| {
        (0..rank).map(|k| a[(i, k)] * a[(j, k)]).sum::<f64>() * unit
    });
    if draws.chance(0.5) {
        let twist = draws.decades(-6.0, -1.0);
        for i in 0..size {
            for j in 0..size {
                if i != j {
                    let both = (w[(i, i)] * w[(j, j)]).sqrt();
                    w[(i, j)] += twist * draws.within(-1.0, 1.0) * both;
                }
            }
        }
    }
    w
}

/// Reactions and velocities that obey the law, contact by contact: free, stuck or sliding.
fn pair(draws: &mut Draws, cone: Cone, mu: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let d = cone.dim();
    let (mut r, mut u) = (vec![0.0; mu.len() * d], vec![0.0; mu.len() * d]);
    for (c, &mu) in mu.iter().enumerate() {
        let angle = draws.within(0.0, std::f64::consts::TAU);
        let direction = match d {
            2 => [angle.cos().signum(), 0.0],
            _ => [angle.cos(), angle.sin()],
        };
        let (push, speed) = (draws.within(0.0, 1.0), draws.within(0.0, 1.0));
        // The friction force stays of order one where the coefficient does not.
        let push = push / mu.max(1.0);
        let (force, slip) = match draws.below(3) {
            0 => {
                u[c * d + d - 1] = speed;
                (0.0, draws.within(-1.0, 1.0))
            }
            1 => {
                r[c * d + d - 1] = push;
                (mu * push * draws.unit(), 0.0)
            }
            _ => {
                r[c * d + d - 1] = push;
                (mu * push, speed)
            }
        };
        for i in 0..d - 1 {
            r[c * d + i] = -force * direction[i];
            u[c * d + i] = slip * direction[i];
        }
    }
    (r, u)
}
