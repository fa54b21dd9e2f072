//! Figures 2 and 3: one bond, pulled along the normal and along the surface.

use std::fmt::Write as _;

use contact_bipotential::{Adhesion, Bond, BondStep};
use nalgebra::Vector3;
use scenarios::output::{Axis, Band, Chart, Curve, MapFrame, Maps, charts_svg, maps_svg};

use super::Figure;
use super::measure::{digits, first_above, integral, peak};
use super::runs::Ran;

/// Deborah numbers `b v / (w x0)`; zero is the rate-independent limit `b = 0`.
const RATES: [f64; 4] = [0.0, 0.01, 0.1, 1.0];
/// Steps a factor of ten of the distance, and the powers of ten from which and to which a bond is pulled, in `x0`.
const PER_DECADE: i32 = 500;
const DECADES: [i32; 2] = [-3, 3];
/// Every so many steps is a point of a curve; the step that ends at `x0` is one of them.
const DRAWN: usize = 5;
/// Largest distance of the charts with equal steps, in `x0`.
const SHOWN: f64 = 5.0;

/// The parameters that most examples of the paper share.
fn law() -> Adhesion {
    Adhesion::new(2e9, 2e9, 20.0, 0.1)
}

fn strength(law: &Adhesion) -> f64 {
    (law.energy * law.normal_stiffness).sqrt()
}

/// A bond that was pulled at constant speed from `beta = 1`.
struct Pull {
    /// Distance \[m\].
    distance: Vec<f64>,
    /// `beta`.
    beta: Vec<f64>,
    /// Bond traction in (t1, t2, n) \[Pa\].
    traction: Vec<[f64; 3]>,
}

impl Pull {
    /// Norm of the traction \[Pa\].
    fn size(&self) -> Vec<f64> {
        let norm = |r: &[f64; 3]| r.iter().map(|c| c * c).sum::<f64>().sqrt();
        self.traction.iter().map(norm).collect()
    }

    /// Largest traction over `s0` and its distance over `x0`.
    fn peak(&self, law: &Adhesion) -> [f64; 2] {
        let (x, r) = peak(&self.distance, &self.size());
        [x / law.damage_gap(), r / strength(law)]
    }

    /// Work until the bond counts as broken, over `w`.
    fn work(&self, law: &Adhesion) -> f64 {
        integral(&self.distance, &self.size()) / law.energy
    }

    /// Distance at which `beta` falls below epsilon, over `x0`.
    fn parted(&self, law: &Adhesion) -> Option<f64> {
        let lost: Vec<f64> = self.beta.iter().map(|beta| 1.0 - beta).collect();
        let at = first_above(&self.distance, &lost, 1.0 - law.threshold);
        at.map(|x| x / law.damage_gap())
    }

    fn curve(&self, name: &str, shown: f64, y: &[f64]) -> Curve {
        let near = self.distance.iter().filter(|x| **x <= shown).count();
        let thin = |values: &[f64]| -> Vec<f64> {
            let steps = values[1..near].iter().step_by(DRAWN);
            values[..1].iter().chain(steps).copied().collect()
        };
        Curve::new(name, &thin(&self.distance), &thin(y))
    }
}

/// The bond at the rate `de`: the same law with `b = 0` for none.
fn pull(law: &Adhesion, de: f64, direction: [f64; 3]) -> Pull {
    let mut law = *law;
    if de == 0.0 {
        law.viscosity = 0.0;
    }
    let x0 = law.damage_gap();
    let speed = if de == 0.0 {
        1.0
    } else {
        de * law.energy * x0 / law.viscosity
    };
    let mut pull = Pull {
        distance: vec![0.0],
        beta: vec![1.0],
        traction: vec![[0.0; 3]],
    };
    let mut bond = Bond::new(1.0, 0.0, [0.0; 2]);
    let mut last = 0.0;
    // The distance x0, at which damage starts, ends a step.
    for k in DECADES[0] * PER_DECADE..=DECADES[1] * PER_DECADE {
        let distance = x0 * 10_f64.powf(f64::from(k) / f64::from(PER_DECADE));
        let moved = distance - last;
        let x = Vector3::new(
            moved * direction[0],
            moved * direction[1],
            distance * direction[2],
        );
        let step = BondStep::new(&law, 1.0, moved / speed, bond, 0.0);
        bond = step.finish(&x);
        let holds = bond.intensity > 0.0;
        pull.distance.push(distance);
        pull.beta.push(bond.intensity);
        pull.traction.push(if holds {
            step.at(&x).force.into()
        } else {
            [0.0; 3]
        });
        last = distance;
    }
    pull
}

pub(super) fn figures(_: &[Ran]) -> Result<Vec<Figure>, String> {
    Ok(vec![normal()?, tangential()?])
}

fn name(de: f64) -> String {
    if de == 0.0 {
        "b = 0".to_owned()
    } else {
        format!("De = {de}")
    }
}

fn normal() -> Result<Figure, String> {
    let law = law();
    let pulls: Vec<Pull> = RATES.map(|de| pull(&law, de, [0.0, 0.0, 1.0])).into();
    let [a, b] = near_charts(&law, &pulls, "Gap");
    let [c, d] = far_charts(&law, &pulls);
    let svg = charts_svg(&[a, b, c, d], 2)?;
    let mut caption = format!(
        "Pull of one bond of area 1 m^2 while the gap opens at constant speed v from beta = 1, computed with `contact_bipotential::rcc`; \
         w = {} J/m^2, C_n = {:e} N/m^3, so that x0 = sqrt(w / C_n) = {:e} m and s0 = sqrt(w C_n) = {:e} Pa; De = b v / (w x0). Shades: the \
         paper's phases, fully bonded up to x0, damage, separation once beta < epsilon = {:e} (the boundaries of De = {}).\n\n",
        law.energy,
        law.normal_stiffness,
        law.damage_gap(),
        strength(&law),
        law.threshold,
        RATES[1],
    );
    caption += &table(&law, &pulls);
    let at_end = |pull: &Pull| {
        let broken = pull.size().into_iter().rfind(|r| *r > 0.0);
        broken.unwrap_or(f64::NAN) / strength(&law)
    };
    let _ = write!(
        caption,
        "\n**Agrees:** three phases; the force is linear while beta = 1, rises a little beyond x0 when the rate is finite, then falls with \
         beta^2.\n\n**Differs:** the paper prints the force as `+C_n x_n beta^2` on a body that is pulled back; here its sign is turned \
         (traction on the slave is negative, the chart shows its size). The paper's sketch has no rate; without viscosity the peak is a corner \
         at (x0, s0). The paper finds forces of the order 1e-9 where beta = 1e-4; a steady opening follows beta = w / k, so force / s0 = \
         beta^(3/2): the last force before the bond breaks is {} s0 here for b = 0 and {} s0 for De = 1. A faster last phase, as in the \
         supplement, falls as beta^2.",
        digits(at_end(&pulls[0]), 2),
        digits(at_end(&pulls[3]), 2),
    );
    Ok(Figure {
        number: "2",
        title: "Modified Signorini law with adhesion",
        pictures: vec![("fig02.svg", svg)],
        caption,
    })
}

/// Rate, peak, work, and where the bond is broken.
fn table(law: &Adhesion, pulls: &[Pull]) -> String {
    let mut text = "| rate | peak / s0 | at x / x0 | beta < epsilon at x / x0 | work / w |\n|---|---:|---:|---:|---:|\n"
        .to_owned();
    for (de, pull) in RATES.iter().zip(pulls) {
        let [at, top] = pull.peak(law);
        let parted = pull.parted(law).map_or("-".to_owned(), |x| digits(x, 4));
        let _ = writeln!(
            text,
            "| {} | {} | {} | {parted} | {} |",
            name(*de),
            digits(top, 4),
            digits(at, 4),
            digits(pull.work(law), 5)
        );
    }
    text
}

/// Traction or `beta` of all pulls up to a distance.
fn curves(pulls: &[Pull], shown: f64, traction: bool) -> Vec<Curve> {
    let all = RATES.iter().zip(pulls);
    let one = |(de, pull): (&f64, &Pull)| {
        let y = if traction {
            pull.size()
        } else {
            pull.beta.clone()
        };
        pull.curve(&name(*de), shown, &y)
    };
    all.map(one).collect()
}

fn band(name: &str, from: f64, to: f64) -> Band {
    Band {
        name: name.to_owned(),
        from,
        to,
    }
}

/// Traction and `beta` over the first multiples of `x0`.
fn near_charts(law: &Adhesion, pulls: &[Pull], distance: &str) -> [Chart; 2] {
    let (x0, s0) = (law.damage_gap(), strength(law));
    let near = SHOWN * x0;
    let mut forces = vec![
        Curve::mark("x0", (x0, 0.0), (x0, s0)),
        Curve::mark("s0", (0.0, s0), (near, s0)),
    ];
    forces.extend(curves(pulls, near, true));
    let betas = curves(pulls, near, false);
    let x = || Axis::linear(distance, "m");
    let charts = [
        Chart::new(
            "(a) Traction of the bond",
            x(),
            Axis::linear("Traction", "Pa"),
            forces,
        ),
        Chart::new("(b) Intensity", x(), Axis::linear("beta", "-"), betas),
    ];
    charts.map(|chart| Chart {
        bands: vec![band("bonded", 0.0, x0), band("damage", x0, near)],
        ..chart
    })
}

/// Traction and `beta` over all powers of ten.
fn far_charts(law: &Adhesion, pulls: &[Pull]) -> [Chart; 2] {
    let (x0, s0) = (law.damage_gap(), strength(law));
    let [start, end] = DECADES.map(|power| x0 * 10_f64.powi(power));
    let parted = pulls[1].parted(law).map_or(end, |x| x * x0);
    let mut forces = vec![Curve::mark("s0", (start, s0), (end, s0))];
    forces.extend(curves(pulls, end, true));
    let mut betas = vec![Curve::mark(
        "epsilon",
        (start, law.threshold),
        (end, law.threshold),
    )];
    betas.extend(curves(pulls, end, false));
    let x = || Axis::logarithmic("Gap", "m");
    let power = Axis::logarithmic;
    let charts = [
        Chart::new(
            "(c) Traction until separation",
            x(),
            power("Traction", "Pa"),
            forces,
        ),
        Chart::new(
            "(d) Intensity until separation",
            x(),
            power("beta", "-"),
            betas,
        ),
    ];
    charts.map(|chart| Chart {
        bands: vec![
            band("bonded", start, x0),
            band("damage", x0, parted),
            band("separation", parted, end),
        ],
        ..chart
    })
}

/// Rate of the map, directions around it, distances along each, and their end in `x0`.
const MAP_RATE: f64 = 0.1;
const DIRECTIONS: usize = 48;
const RINGS: usize = 30;
const REACH: f64 = 4.0;

fn tangential() -> Result<Figure, String> {
    let law = law();
    let pulls: Vec<Pull> = RATES.map(|de| pull(&law, de, [1.0, 0.0, 0.0])).into();
    let svg = charts_svg(&near_charts(&law, &pulls, "Slip"), 2)?;
    let [first, second] = law.tangential_stiffness;
    let orthotropic = law.with_tangential_stiffness([first, 0.25 * second]);
    let (round, round_angle) = map(&law);
    let (oval, oval_angle) = map(&orthotropic);
    let maps = Maps {
        title: format!("Size of the tangential traction over (u_t1, u_t2), De = {MAP_RATE}"),
        quantity: "Traction".to_owned(),
        unit: "Pa".to_owned(),
        facets: facets(),
        columns: vec![
            "(c) C_t2 = C_t1".to_owned(),
            "(d) C_t2 = C_t1 / 4".to_owned(),
        ],
        rows: vec![(format!("|u_t| < {REACH} x0"), vec![round, oval])],
    };
    let mut caption = format!(
        "(a), (b): as figure 2 (a), (b), for slip of a pair that stays in contact, C_t = {:e} N/m^3. (c): the paper's cone seen from above: \
         the bond is pulled from the centre in {DIRECTIONS} directions, colours are the size of its traction. (d): two tangential stiffnesses, \
         which the paper leaves to later work.\n\n",
        first
    );
    caption += &table(&law, &pulls);
    let _ = write!(
        caption,
        "\n**Agrees:** the three phases in slip; for one stiffness the traction lies on a circle for every slip and points straight back: the \
         largest angle between it and -u_t is {} degrees in (c), {} degrees in (d).\n\n**Differs:** a pair that slips while it touches \
         forms bonds as it breaks them, so beta follows w / k and is not cut at epsilon: the column beta < epsilon says where it gets there, \
         the work goes on beyond it, over {:e} x0 in the table. The paper's `x_t` is two things: the slip of a step in Coulomb's rule and the \
         separation since bonding u_t in the bond; here only u_t acts.",
        digits(round_angle, 2),
        digits(oval_angle, 3),
        10_f64.powi(DECADES[1]),
    );
    Ok(Figure {
        number: "3",
        title: "Modified Coulomb rule with adhesion: the tangential bond force",
        pictures: vec![("fig03.svg", svg), ("fig03_map.svg", maps_svg(&maps)?)],
        caption,
    })
}

/// Size of the traction over the plane of slips, and the largest angle between the traction and minus the slip
/// \[degrees\].
fn map(law: &Adhesion) -> (MapFrame, f64) {
    let reach = REACH * law.damage_gap();
    let mut frame = MapFrame {
        points: vec![[0.0; 2]],
        values: vec![0.0],
    };
    let mut widest: f64 = 0.0;
    for k in 0..DIRECTIONS {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / DIRECTIONS as f64).sin_cos();
        let pull = pull(law, MAP_RATE, [cos, sin, 0.0]);
        let sizes = pull.size();
        for ring in 1..=RINGS {
            let distance = reach * ring as f64 / RINGS as f64;
            let i = pull.distance.partition_point(|x| *x < distance);
            let [t1, t2, _] = pull.traction[i];
            let aligned = -(t1 * cos + t2 * sin);
            let across = t1 * sin - t2 * cos;
            widest = widest.max(across.abs().atan2(aligned).to_degrees());
            frame.points.push([distance * cos, distance * sin]);
            frame.values.push(sizes[i]);
        }
    }
    (frame, widest)
}

/// Facets between the points of [`map`]: triangles around the centre, quadrilaterals between rings.
fn facets() -> Vec<Vec<usize>> {
    let node = |direction: usize, ring: usize| match ring {
        0 => 0,
        _ => 1 + (direction % DIRECTIONS) * RINGS + ring - 1,
    };
    let cell = |direction: usize, ring: usize| {
        let mut corners = vec![node(direction, ring), node(direction, ring + 1)];
        corners.extend([node(direction + 1, ring + 1), node(direction + 1, ring)]);
        corners.dedup();
        if ring == 0 {
            corners.pop();
        }
        corners
    };
    let directions = 0..DIRECTIONS;
    directions
        .flat_map(|d| (0..RINGS).map(move |ring| cell(d, ring)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `beta` at the distance `x` in `x0`.
    fn beta_at(pull: &Pull, law: &Adhesion, x: f64) -> f64 {
        let i = pull.distance.partition_point(|d| *d < x * law.damage_gap());
        let (a, b) = (pull.distance[i - 1], pull.distance[i]);
        let share = (x * law.damage_gap() - a) / (b - a);
        pull.beta[i - 1] + share * (pull.beta[i] - pull.beta[i - 1])
    }

    #[test]
    fn the_peak_tends_to_the_strength_and_the_work_to_w() {
        let law = law();
        for direction in [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.6, 0.0, 0.8]] {
            let mut last = [f64::MAX; 3];
            for de in [0.3, 0.03, 3e-3, 3e-4, 0.0] {
                let pull = pull(&law, de, direction);
                let [at, top] = pull.peak(&law);
                let off = [at - 1.0, top - 1.0, (pull.work(&law) - 1.0).abs()];
                for (now, before) in off.iter().zip(last) {
                    assert!(*now <= before + 1e-3, "{de} {direction:?} {off:?} {last:?}");
                }
                last = off;
            }
            assert!(last[0].abs() < 1e-9 && last[1].abs() < 1e-9, "{last:?}");
            assert!(last[2] < 1e-3, "{direction:?} {last:?}");
        }
    }

    #[test]
    fn the_ramp_has_its_closed_form() {
        let law = law();
        let pull = pull(&law, 1.0, [0.0, 0.0, 1.0]);
        assert!((beta_at(&pull, &law, 2.0) - 0.404_831_811_977_178).abs() < 1e-4);
        assert_eq!(beta_at(&pull, &law, 0.9), 1.0);
    }

    #[test]
    fn an_isotropic_bond_pulls_straight_back() {
        let (frame, angle) = map(&law());
        assert!(angle < 1e-6, "{angle}");
        let used = facets().into_iter().flatten().max();
        assert_eq!(used, Some(frame.points.len() - 1));
        assert_eq!(facets()[0].len(), 3);
    }
}
