//! Runs drawn from a seed and an index, with at least one thing extreme.

use oorandom::Rand64;

use super::subject::{Bond, Case, Draw, Extreme, Hold, Kind, Law, Shape};

/// Seeded numbers with the few distributions that are needed.
struct Dice(Rand64);

impl Dice {
    fn chance(&mut self, p: f64) -> bool {
        self.0.rand_float() < p
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.rand_float()
    }

    /// Evenly in the logarithm.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.within(low, high))
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.0.rand_range(0..all.len() as u64) as usize]
    }

    fn count(&mut self, low: u64, high: u64) -> usize {
        self.0.rand_range(low..high + 1) as usize
    }
}

/// The run `index` of a seed; the directions take turns, so that each has its share.
pub(super) fn draw(seed: u64, index: usize) -> Draw {
    let mut dice = Dice(Rand64::new((u128::from(seed) << 64) | index as u128));
    let mut extremes = vec![Extreme::ALL[index % Extreme::ALL.len()].0];
    while dice.chance(0.3) {
        let (other, _) = dice.one_of(&Extreme::ALL);
        if !extremes.contains(&other) {
            extremes.push(other);
        }
    }
    let mut draw = usual(&mut dice, &extremes);
    for extreme in extremes.clone() {
        push(&mut draw, extreme, &mut dice);
    }
    reconcile(&mut draw);
    // The audit knows the shape of rigid masters only, where faces are curved.
    draw.quadratic = !draw.round && !draw.case.has_second_body() && dice.chance(0.3);
    let linear_simplices = draw.simplex && !draw.round && !draw.quadratic;
    draw.projected = dice.chance(0.3) && !linear_simplices;
    draw
}

/// A run without anything extreme.
fn usual(dice: &mut Dice, extremes: &[Extreme]) -> Draw {
    let case = dice.one_of(&Case::ALL);
    let kind = dice.one_of(&[Kind::Plane, Kind::Plane, Kind::Axisymmetric, Kind::Space]);
    let most = if kind == Kind::Space { 3 } else { 5 };
    let free = !case.is_held();
    let ([theta, xi], velocity_level) = scheme(dice);
    Draw {
        case,
        extremes: extremes.to_vec(),
        kind,
        round: dice.chance(0.4),
        simplex: dice.chance(0.3),
        quadratic: false,
        projected: false,
        cells: [dice.count(1, most), dice.count(1, most)],
        width: dice.within(0.5, 1.5),
        height: dice.within(0.5, 1.0),
        grading: 1.0,
        law: dice.one_of(&Law::ALL),
        nu: dice.within(0.0, 0.4),
        modulus: 1.0,
        density: 1.0,
        mu: dice.one_of(&[0.0, 0.2, 0.6]),
        bond: dice.chance(0.25).then(|| bond(dice)),
        restitution: 0.0,
        theta,
        xi,
        velocity_level,
        quasi_static: !free && dice.chance(0.4),
        lumped: dice.chance(0.3),
        damping: damping(dice),
        dt: 0.2,
        steps: dice.count(12, 25),
        speed: [dice.within(-0.05, 0.05), dice.within(0.02, 0.1)],
        gap: dice.within(0.0, 0.03),
        depth: dice.within(0.02, 0.15),
        slide: dice.within(0.0, 0.2),
        turn: 0.0,
        flicker: false,
        pull: dice.chance(0.3),
        shape: shape(dice),
        hold: if free { Hold::Free } else { Hold::Face },
        traction: 0.0,
        gravity: 0.0,
        matching: dice.chance(0.3),
        overhang: false,
        // Centimetres, grams and wave times of a soft rubber.
        units: [1e-2, 1e-3, 3e-4],
    }
}

/// Weights `theta` and `xi` of the time scheme, and whether the contact law acts on velocities.
fn scheme(dice: &mut Dice) -> ([f64; 2], bool) {
    let scheme = dice.count(0, 4);
    let weights = match scheme {
        0 | 1 => [0.5; 2],
        2 => [1.0; 2],
        _ => [dice.within(0.5, 1.0), dice.within(0.5, 1.0)],
    };
    (weights, scheme == 1)
}

/// Mass and stiffness damping.
fn damping(dice: &mut Dice) -> [f64; 2] {
    if dice.chance(0.2) {
        [dice.within(0.0, 0.2), dice.within(0.0, 0.2)]
    } else {
        [0.0; 2]
    }
}

fn shape(dice: &mut Dice) -> Shape {
    match dice.count(0, 3) {
        0 => Shape::Plane(dice.within(0.0, 0.3)),
        1 => Shape::Sphere(dice.within(0.5, 3.0)),
        2 => Shape::Cylinder(dice.within(0.5, 3.0)),
        _ => Shape::Plane(0.0),
    }
}

fn bond(dice: &mut Dice) -> Bond {
    let viscosity = dice.decades(-6.0, -3.0);
    Bond {
        stiffness: dice.within(0.3, 3.0),
        energy: dice.decades(-4.5, -3.0),
        viscosity,
        initial: dice.one_of(&[0.0, 1.0]),
        irreversible: dice.chance(0.25),
        ageing: dice.chance(0.25),
        consistent: dice.chance(0.25),
        bonded_friction: dice.chance(0.25).then(|| dice.within(0.0, 1.0)),
        healing_gap: if dice.chance(0.2) { 1e-3 } else { 0.0 },
    }
}

/// Leaves what is usual in one direction.
fn push(draw: &mut Draw, extreme: Extreme, dice: &mut Dice) {
    match extreme {
        Extreme::Friction => draw.mu = dice.one_of(&[1.0, 1.9, 3.0, 10.0]),
        Extreme::Stiffness => stiffness(draw, dice),
        Extreme::Density => draw.density = dice.decades(-6.0, 6.0),
        Extreme::LongSteps => {
            draw.dt *= dice.decades(1.0, 2.0);
            draw.steps = dice.count(2, 8);
        }
        Extreme::ShortSteps => short_steps(draw, dice),
        Extreme::Speed => speed(draw, dice),
        Extreme::Slivers => slivers(draw, dice),
        Extreme::Incompressible => {
            draw.nu = 0.5 - dice.decades(-4.0, -2.0);
            draw.law = dice.one_of(&[Law::SaintVenantKirchhoff, Law::ThreeE, Law::NeoHookean]);
        }
        Extreme::StrongBonds => strong_bonds(draw, dice),
        Extreme::NoViscosity => no_viscosity(draw, dice),
        Extreme::Compression => {
            draw.depth = draw.height * dice.within(0.5, 0.9);
            draw.speed[1] = dice.within(0.3, 1.0);
            draw.steps = dice.count(10, 40);
        }
        Extreme::Overlap => draw.gap = -draw.height * dice.decades(-4.0, -0.2),
        Extreme::NoSupports => draw.hold = Hold::Free,
        Extreme::OneElement => {
            draw.cells = [1, 1];
            draw.round = false;
        }
        Extreme::Flicker => draw.flicker = true,
        Extreme::Units => units(draw, dice),
        Extreme::AllDriven => draw.hold = Hold::All,
        Extreme::DeadLoads => dead_loads(draw, dice),
        Extreme::Sharp => sharp(draw, dice),
        Extreme::Touching => {
            draw.gap = 0.0;
            draw.matching = true;
        }
        Extreme::Restitution => {
            draw.velocity_level = true;
            draw.restitution = dice.one_of(&[0.0, 0.5, 1.0]);
            draw.quasi_static = false;
            draw.bond = None;
        }
        Extreme::Turning => draw.turn = dice.within(0.5, 6.3),
    }
}

fn stiffness(draw: &mut Draw, dice: &mut Dice) {
    draw.modulus = dice.decades(-6.0, 6.0);
    if dice.chance(0.7) {
        draw.case = dice.one_of(&[Case::Pair, Case::Collide]);
    }
}

/// Ways shrink with the steps, or nothing would be reached.
fn short_steps(draw: &mut Draw, dice: &mut Dice) {
    let factor = dice.decades(-8.0, -2.0);
    draw.dt *= factor;
    [draw.depth, draw.slide, draw.gap] = [draw.depth, draw.slide, draw.gap].map(|x| x * factor);
}

fn speed(draw: &mut Draw, dice: &mut Dice) {
    let factor = dice.decades(1.0, 2.0);
    draw.speed = draw.speed.map(|v| v * factor);
    if draw.case.is_held() {
        draw.dt /= factor;
    }
}

fn strong_bonds(draw: &mut Draw, dice: &mut Dice) {
    let mut bond = draw.bond.unwrap_or_else(|| bond(dice));
    bond.stiffness *= dice.decades(2.0, 4.0);
    draw.bond = Some(bond);
    draw.pull = true;
}

fn no_viscosity(draw: &mut Draw, dice: &mut Dice) {
    let mut bond = draw.bond.unwrap_or_else(|| bond(dice));
    bond.viscosity = 0.0;
    bond.consistent = false;
    if dice.chance(0.4) {
        bond.bonded_friction = Some(dice.within(0.0, 2.0));
    }
    draw.bond = Some(bond);
    draw.pull = true;
}

fn units(draw: &mut Draw, dice: &mut Dice) {
    for unit in &mut draw.units {
        if dice.chance(0.6) {
            *unit *= dice.one_of(&[1e-6, 1e-3, 1e3, 1e6]);
        }
    }
}

fn dead_loads(draw: &mut Draw, dice: &mut Dice) {
    let load = dice.decades(-1.0, 1.0) * dice.one_of(&[-1.0, 1.0]);
    if dice.chance(0.5) {
        draw.traction = load;
    } else {
        draw.gravity = load;
    }
}

fn sharp(draw: &mut Draw, dice: &mut Dice) {
    draw.overhang = true;
    draw.shape = if dice.chance(0.6) {
        Shape::Cone(dice.within(5.0, 89.0))
    } else {
        Shape::Sphere(dice.decades(-2.0, -0.7))
    };
}

fn slivers(draw: &mut Draw, dice: &mut Dice) {
    let aspect = dice.decades(1.5, 3.0);
    match dice.count(0, 2) {
        0 => {
            draw.grading = if dice.chance(0.5) {
                aspect
            } else {
                1.0 / aspect
            }
        }
        1 => {
            draw.height = draw.width / aspect;
            [draw.depth, draw.slide, draw.gap] =
                [draw.depth, draw.slide, draw.gap].map(|x| x * draw.height);
            draw.dt *= draw.height;
        }
        _ => draw.width = draw.height / aspect,
    }
    draw.round = false;
}

/// Takes back what cannot go together, so that no run is spent on a scene that the reader of scenes refuses.
fn reconcile(draw: &mut Draw) {
    if draw.kind == Kind::Axisymmetric {
        (draw.slide, draw.turn, draw.speed[0]) = (0.0, 0.0, 0.0);
        draw.shape = match draw.shape {
            Shape::Plane(_) => Shape::Plane(0.0),
            Shape::Cylinder(radius) => Shape::Sphere(radius),
            other => other,
        };
    }
    if draw.hold == Hold::All && !draw.case.is_held() {
        draw.case = Case::Press;
    }
    if draw.hold == Hold::Face && !draw.case.is_held() {
        draw.hold = Hold::Free;
    }
    if !draw.case.is_held() {
        // Without inertia nothing but a refusal can come of a free body, and one direction is enough to see it.
        draw.quasi_static &= draw.extremes.contains(&Extreme::NoSupports);
    }
    if draw.velocity_level && draw.bond.is_some() {
        draw.velocity_level = false;
    }
    if draw.velocity_level {
        draw.quasi_static = false;
    } else {
        draw.restitution = 0.0;
    }
    if draw.kind == Kind::Plane && matches!(draw.case, Case::Indent | Case::Squeeze) {
        // An obstacle that goes round would sweep away the body.
        draw.turn = draw.turn.min(0.3);
    }
    if draw.case == Case::Squeeze {
        draw.gap = draw.gap.min(0.01 * draw.height);
        if draw.kind == Kind::Axisymmetric {
            draw.round = false;
        }
    }
    if draw.quasi_static {
        draw.speed = [0.0; 2];
    }
    if !draw.case.is_held() && draw.gap > 0.0 {
        // What flies arrives in the third step.
        draw.gap = 2.5 * draw.dt * draw.speed[1];
    }
}
