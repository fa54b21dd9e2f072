//! Every accepted step recomputed from its state: what the program reports about itself is not taken for granted.

use contact_bipotential::Master;
use fe_core::ElementWorkspace;
use nalgebra::Vector3;
use nscd::{
    ContactLevel, ContactState, Inertia, Model, Observer, State, StepReport, Stepper, Totals,
};

use super::geometry::{deepest, deepest_on_the_way, positions, warp};

/// Newton corrections after which a run is cut.
const MOST_ITERATIONS: u64 = 40_000;

/// Largest open share of the energy audit \[-\].
const ENERGY: f64 = 1e-6;
/// Largest force left over at a free unknown, over the largest force in play \[-\].
const RESIDUAL: f64 = 1e-8;
/// Largest error of the contact law that is not round-off \[-\].
const LAW: f64 = 1e-7;
/// Largest difference of a recomputed energy from the reported one, over the energy \[-\]: round-off of the sums.
const SAME_ENERGY: f64 = 1e-12;
/// Deepest penetration over the smallest edge of the mesh \[-\].
const DEPTH: f64 = 1e-5;

/// The worst of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Worst {
    pub(super) energy: f64,
    pub(super) residual: f64,
    pub(super) law: f64,
    /// Over the smallest edge.
    pub(super) depth: f64,
    /// Share of the energy that the time integration made up.
    pub(super) integration: f64,
    /// As the program reports it.
    pub(super) contact_error: f64,
}

/// Watches a run and ends it at the first step that is not what it claims to be.
pub(super) struct Auditor<'a> {
    model: &'a Model,
    work: ElementWorkspace,
    damping: ElementWorkspace,
    before: State,
    start_energy: f64,
    works: f64,
    edge: f64,
    /// Longest distance in an element: strains carry the round-off of numbers of size one.
    element: f64,
    extent: f64,
    /// Largest displacement so far.
    way: f64,
    /// Mass of the heaviest unknown and stiffness of the stiffest at the start.
    mass: f64,
    stiffness: f64,
    pub(super) worst: Worst,
    pub(super) fault: Option<String>,
    pub(super) over_budget: bool,
}

impl<'a> Auditor<'a> {
    pub(super) fn new(model: &'a Model, start: &State) -> Result<Self, String> {
        let text = |e: fe_core::FeError| e.to_string();
        let n = model.dof_count();
        let mut damping = model.solid.workspace();
        model
            .solid
            .tangent(&vec![0.0; n], &mut damping, &mut vec![0.0; n])
            .map_err(text)?;
        let x = positions(model, &start.u);
        Ok(Auditor {
            model,
            work: model.solid.workspace(),
            damping,
            before: start.clone(),
            start_energy: start.kinetic_energy + start.strain_energy + start.adhesive_energy,
            works: 0.0,
            edge: edges(model).fold(f64::INFINITY, f64::min),
            element: edges(model).fold(0.0, f64::max),
            extent: x.iter().flatten().fold(0.0, |m: f64, c| m.max(c.abs())),
            way: largest(&start.u),
            mass: largest(&model.mass.row_sums()),
            stiffness: stiffness(model, &vec![0.0; n])?,
            worst: Worst::default(),
            fault: None,
            over_budget: false,
        })
    }

    fn audit(&mut self, state: &State, report: &StepReport, totals: &Totals) -> Result<(), String> {
        finite(state, report)?;
        self.balance(state, report)?;
        self.energies(state, report, totals)?;
        self.contacts(state, report)?;
        self.geometry(state, report)?;
        self.worst.contact_error = self.worst.contact_error.max(report.contact_error);
        Ok(())
    }

    /// Force that the round-off of positions of the size `extent` \[m\] makes by stiffness, damping and inertia, with
    /// room for the sums \[N\].
    fn round_off(&self, extent: f64, state: &State, dt: f64) -> f64 {
        let damping = &self.model.damping;
        let drag = (damping.mass * self.mass + damping.stiffness * self.stiffness) / dt;
        let rate = match self.model.scheme.inertia {
            Inertia::Dynamic => drag + self.mass / (dt * dt),
            Inertia::QuasiStatic => drag,
        };
        let travel = largest(&state.u) + dt * largest(&state.v) + extent;
        1e4 * f64::EPSILON * (rate + self.stiffness) * travel
    }

    /// `A v` by the damping of the scene.
    fn damping_force(&self, v: &[f64]) -> Vec<f64> {
        let (mut inertial, mut elastic) = (vec![0.0; v.len()], vec![0.0; v.len()]);
        self.model.mass.times(v, &mut inertial);
        self.model
            .solid
            .tangent_times(&self.damping, v, &mut elastic);
        let (alpha, beta) = (self.model.damping.mass, self.model.damping.stiffness);
        inertial
            .iter()
            .zip(&elastic)
            .map(|(m, k)| alpha * m + beta * k)
            .collect()
    }

    /// Internal forces of the state, and its strain energy against the reported one.
    fn internal_force(&mut self, state: &State) -> Result<Vec<f64>, String> {
        let mut internal = vec![0.0; self.model.dof_count()];
        let energy = (self.model.solid)
            .internal_force(&state.u, &mut self.work, &mut internal)
            .map_err(|e| format!("an accepted state is inverted: {e}"))?;
        let off = (energy - state.strain_energy).abs();
        if off > SAME_ENERGY * energy.abs().max(state.strain_energy.abs()) {
            return Err(format!(
                "strain energy {energy:e} J, reported {:e} J",
                state.strain_energy
            ));
        }
        Ok(internal)
    }

    /// Forces against inertia at every free unknown, and in sum against what interfaces and supports report.
    fn balance(&mut self, state: &State, report: &StepReport) -> Result<(), String> {
        let model = self.model;
        let before = self.before.clone();
        let (n, dim) = (model.dof_count(), model.solid.dim());
        let dynamic = model.scheme.inertia == Inertia::Dynamic;
        let xi = if dynamic { model.scheme.xi } else { 1.0 };
        let internal = self.internal_force(state)?;
        let (d0, d1) = (self.damping_force(&before.v), self.damping_force(&state.v));
        let mut inertia = vec![0.0; n];
        if dynamic {
            let rates = state.v.iter().zip(&before.v);
            let rate: Vec<f64> = rates
                .map(|(end, start)| (end - start) / report.dt)
                .collect();
            model.mass.times(&rate, &mut inertia);
        }
        let at = |start: &[f64], end: &[f64], i: usize| (1.0 - xi) * start[i] + xi * end[i];
        let applied: Vec<f64> = (0..n)
            .map(|i| {
                at(&before.external_force, &state.external_force, i) - at(&d0, &d1, i) - inertia[i]
            })
            .collect();
        let fixed = prescribed(model);
        let fields = [
            &internal,
            &state.external_force,
            &state.contact_force,
            &d1,
            &inertia,
        ];
        let scale = fields.into_iter().map(|f| largest(f)).fold(0.0, f64::max);
        let mut round_off = self.round_off(self.element, state, report.dt);
        let mut worst = 0.0_f64;
        for i in (0..n).filter(|i| !fixed[*i]) {
            let left =
                applied[i] - at(&before.internal_force, &internal, i) + state.contact_force[i];
            worst = worst.max(left.abs());
        }
        if worst > RESIDUAL * scale + round_off {
            // A crushed element is stiffer than it was, and so are its round-off errors.
            self.stiffness = stiffness(model, &state.u)?;
            round_off = self.round_off(self.element, state, report.dt);
        }
        if worst > RESIDUAL * scale + round_off {
            return Err(format!(
                "{worst:e} N are left over at a node, the largest force is {scale:e} N"
            ));
        }
        self.worst.residual = self
            .worst
            .residual
            .max((worst - round_off).max(0.0) / scale.max(f64::MIN_POSITIVE));
        self.resultants(report, &applied, dim, scale, round_off)
    }

    /// What obstacles and supports give is what accelerates the bodies.
    fn resultants(
        &self,
        report: &StepReport,
        applied: &[f64],
        dim: usize,
        scale: f64,
        round_off: f64,
    ) -> Result<(), String> {
        let axisymmetric = self.model.solid.mesh().symmetry == fe_core::Symmetry::Axisymmetric;
        for c in usize::from(axisymmetric)..dim {
            let mut sum: f64 = applied.iter().skip(c).step_by(dim).sum();
            let rigid = self.model.interfaces.iter().zip(&report.interfaces);
            let rigid = rigid.filter(|(i, _)| matches!(i.master, Master::Obstacle(_)));
            sum += rigid.map(|(_, r)| r.force[c]).sum::<f64>();
            sum += report.supports.iter().map(|r| r.force[c]).sum::<f64>();
            let many = applied.len() as f64;
            if sum.abs() > many * (RESIDUAL * scale + round_off) {
                return Err(format!(
                    "reactions and inertia differ by {sum:e} N along axis {c}"
                ));
            }
        }
        Ok(())
    }

    fn energies(
        &mut self,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), String> {
        let kinetic = self.model.kinetic_energy(&state.v);
        if (kinetic - state.kinetic_energy).abs() > SAME_ENERGY * kinetic.abs() {
            return Err(format!(
                "kinetic energy {kinetic:e} J, reported {:e} J",
                state.kinetic_energy
            ));
        }
        let step = &report.energy;
        self.works +=
            step.load_work.abs() + step.friction.abs() + step.impact.abs() + step.bulk_error.abs();
        let sums = &totals.energy;
        let scale = totals
            .largest_energy
            .max(self.works)
            .max(self.start_energy.abs());
        let now = state.kinetic_energy + state.strain_energy + state.adhesive_energy;
        let told = sums.kinetic + sums.strain + sums.adhesive;
        let open = sums
            .imbalance()
            .abs()
            .max((now - self.start_energy - told).abs());
        // What the forces that count as zero can do along the way.
        self.way = self.way.max(largest(&state.u));
        let round_off = self.round_off(self.element, state, report.dt) * self.way;
        if open > ENERGY * scale + round_off {
            return Err(format!("the energy audit leaves {open:e} J of {scale:e} J"));
        }
        let share = |part: f64| if scale > 0.0 { part / scale } else { 0.0 };
        self.worst.energy = self.worst.energy.max(share((open - round_off).max(0.0)));
        self.worst.integration = self
            .worst
            .integration
            .max(share(sums.integration_error().abs()));
        Ok(())
    }

    /// Cone, complementarity, dissipation, intensities.
    fn contacts(&mut self, state: &State, report: &StepReport) -> Result<(), String> {
        let force = state
            .contacts
            .iter()
            .map(|c| c.force.amax())
            .fold(0.0, f64::max);
        // Below the round-off of the forces that move the nodes no contact force is known.
        let known = force.max(self.round_off(self.extent, state, report.dt) / LAW);
        for c in &state.contacts {
            let interface = &self.model.interfaces[c.interface];
            let dry = c.force - c.bond.map_or(Vector3::zeros(), |b| b.force);
            let mut mu = interface.mu;
            if let (Some(bond), Some(law)) = (c.bond, &interface.adhesion) {
                if !(0.0..=1.0).contains(&bond.intensity) {
                    return Err(format!("beta = {} at node {}", bond.intensity, c.node));
                }
                mu += bond.intensity * (law.bonded_friction.unwrap_or(mu) - mu);
            }
            let friction = dry[0].hypot(dry[1]);
            let mut error = (-dry[2]).max(friction - mu * dry[2]).max(0.0) / known;
            error = error.max(self.complementarity(c, dry, mu) / known);
            if error > LAW {
                return Err(format!(
                    "node {} breaks the contact law by {error:e}: force {:?} N, gap {:e} m, slip {:?} m",
                    c.node,
                    dry.as_slice(),
                    c.gap,
                    c.slip
                ));
            }
            self.worst.law = self.worst.law.max(error);
        }
        Ok(())
    }

    /// Bi-potential gap of a contact over the extent of the bodies \[N\].
    fn complementarity(&self, c: &ContactState, dry: Vector3<f64>, mu: f64) -> f64 {
        if self.model.scheme.contact == ContactLevel::Velocity {
            return 0.0;
        }
        let slip = c.slip[0].hypot(c.slip[1]);
        let normal = dry[2] * c.gap.max(0.0);
        let tangential = mu * dry[2].max(0.0) * slip + dry[0] * c.slip[0] + dry[1] * c.slip[1];
        (normal.abs() + tangential.abs()) / self.extent
    }

    /// Penetrations recomputed from the positions, at the end and on the way.
    fn geometry(&mut self, state: &State, report: &StepReport) -> Result<(), String> {
        let model = self.model;
        let x = positions(model, &state.u);
        let (depth, node) = deepest(model, &x, state.time);
        let allowed = DEPTH * self.edge + warp(model, &x);
        let told = match model.scheme.contact {
            ContactLevel::Position => 0.0,
            ContactLevel::Velocity => report.penetration,
        };
        if depth > told * (1.0 + 1e-6) + allowed {
            return Err(format!(
                "node {node} lies {depth:e} m in its master, reported are {:e} m; the smallest edge is {:e} m",
                report.penetration, self.edge
            ));
        }
        self.worst.depth = self.worst.depth.max(depth / self.edge);
        let start = positions(model, &self.before.u);
        let (first, _) = deepest(model, &start, self.before.time);
        let way = deepest_on_the_way(model, [&start, &x], [self.before.time, state.time]);
        let travel = report.dt * largest(&state.v).max(largest(&self.before.v));
        // A straight way along a round obstacle cuts through it a little.
        if way > first.max(depth) + 0.5 * travel.max(self.edge) + allowed {
            return Err(format!(
                "a node passed {way:e} m deep through an obstacle in one step"
            ));
        }
        Ok(())
    }
}

impl Observer for Auditor<'_> {
    fn accepted(
        &mut self,
        stepper: &Stepper<'_>,
        state: &State,
        report: &StepReport,
        totals: &Totals,
    ) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        if let Err(fault) = self.audit(state, report, totals) {
            let fault = format!(
                "t = {:e} s, step {}: {fault}",
                state.time,
                stepper.counters().steps
            );
            self.fault = Some(fault.clone());
            return Err(fault.into());
        }
        self.before = state.clone();
        if stepper.counters().newton_iterations > MOST_ITERATIONS {
            self.over_budget = true;
            return Err("over budget".into());
        }
        Ok(())
    }
}

fn finite(state: &State, report: &StepReport) -> Result<(), String> {
    let fields = [
        ("displacement", &state.u),
        ("velocity", &state.v),
        ("internal force", &state.internal_force),
        ("support force", &state.support_force),
        ("contact force", &state.contact_force),
    ];
    for (name, values) in fields {
        if values.iter().any(|v| !v.is_finite()) {
            return Err(format!("a {name} is not finite"));
        }
    }
    let contacts = state.contacts.iter();
    let local = contacts.flat_map(|c| {
        let force = <[f64; 3]>::from(c.force).into_iter();
        force.chain(c.slip).chain([c.gap])
    });
    let numbers = [
        state.kinetic_energy,
        state.strain_energy,
        state.adhesive_energy,
        report.residual,
        report.contact_error,
        report.penetration,
        report.energy.imbalance(),
    ];
    if local.chain(numbers).any(|v| !v.is_finite()) {
        return Err("a reported number is not finite".into());
    }
    Ok(())
}

/// How stiff the stiffest unknown is, about \[N/m\].
fn stiffness(model: &Model, u: &[f64]) -> Result<f64, String> {
    let n = model.dof_count();
    let (mut work, mut force) = (model.solid.workspace(), vec![0.0; n]);
    let tangent = model.solid.tangent(u, &mut work, &mut force);
    tangent.map_err(|e| e.to_string())?;
    // Signs without a pattern, or a rigid motion could hide in them.
    let sign = |i: usize| {
        if (i * i * i + i / 2) % 7 < 3 {
            1.0
        } else {
            -1.0
        }
    };
    let rough: Vec<f64> = (0..n).map(sign).collect();
    model.solid.tangent_times(&work, &rough, &mut force);
    Ok(largest(&force))
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

fn prescribed(model: &Model) -> Vec<bool> {
    let dim = model.solid.dim();
    let mut fixed = vec![false; model.dof_count()];
    for support in &model.supports {
        for &node in &support.nodes {
            for c in (0..dim).filter(|c| support.components[*c]) {
                fixed[dim * node as usize + c] = true;
            }
        }
    }
    fixed
}

/// Distances between the nodes of each element \[m\].
fn edges(model: &Model) -> impl Iterator<Item = f64> + '_ {
    let points = &model.solid.mesh().points;
    let distance = |a: u32, b: u32| (points[a as usize] - points[b as usize]).norm();
    let cells = model.solid.blocks().iter();
    let cells = cells.flat_map(|b| b.connectivity().chunks_exact(b.nodes_per_element()));
    let pairs = cells.flat_map(|cell| {
        let pairs = cell.iter().enumerate();
        pairs.flat_map(move |(i, a)| cell[..i].iter().map(move |b| (*a, *b)))
    });
    pairs.map(move |(a, b)| distance(a, b)).filter(|d| *d > 0.0)
}
