//! From a checked scene to a model.

mod mesh;

use contact_bipotential::{Adhesion, Interface, Master, Obstacle};
use fe_core::{
    Block, DeadTraction, Dirichlet, FeError, Gravity, Mesh, Motion, Rotation, Solid, Surface,
    Table, ValidMesh,
};
use nalgebra::Vector3;
use nscd::{Load, Model, Scheme, Settings, Span};

use crate::spec::{self, LoadedScene, Scene, SceneError, Side};

/// A scene ready to run.
#[derive(Debug)]
#[non_exhaustive]
pub struct Built {
    /// Everything that does not change.
    pub model: Model,
    /// Initial velocity, flat \[m/s\].
    pub velocity: Vec<f64>,
    /// Duration and step.
    pub span: Span,
    /// Node of each probe, in the order of the scene.
    pub probes: Vec<u32>,
    /// Body of each mesh block, in the order of the scene.
    pub body_of_block: Vec<i32>,
}

/// Builds the model of a scene.
///
/// # Errors
/// [`SceneError`] at the value of the scene that cannot be built: a parameter outside of its bound, a mesh that is
/// inverted, an interface that makes no sense.
pub fn build(loaded: &LoadedScene) -> Result<Built, SceneError> {
    let scene = &loaded.scene;
    let (mesh, first_node) = mesh::mesh(loaded)?;
    let blocks = blocks(loaded, &mesh)?;
    let body_of_block = (0..mesh.blocks.len() as i32).collect();
    let solid = Solid::new(mesh, blocks).map_err(|e| loaded.refuse("bodies", e.to_string()))?;
    let mass = match scene.mass {
        spec::MassKind::Consistent => solid.consistent_mass(),
        spec::MassKind::Lumped => solid.lumped_mass(),
    };
    let dim = solid.dim();
    let mut velocity = vec![0.0; solid.dof_count()];
    for (k, body) in scene.bodies.values().enumerate() {
        for node in first_node[k]..first_node[k + 1] {
            let start = body.velocity_at(solid.mesh().points[node].into());
            velocity[dim * node..dim * (node + 1)].copy_from_slice(&start[..dim]);
        }
    }
    let (supports, interfaces) = (
        supports(loaded, solid.mesh())?,
        interfaces(loaded, solid.mesh())?,
    );
    let loads = loads(loaded, &solid, &mass)?;
    let mut model = Model::new(solid)
        .with_mass(mass)
        .with_damping(scene.damping)
        .with_scheme(scheme(scene))
        .with_settings(settings(scene));
    (model.supports, model.loads, model.interfaces) = (supports, loads, interfaces);
    let probes = probes(loaded, model.solid.mesh(), &first_node)?;
    let span = Span::new(scene.time.end, scene.time.dt);
    Ok(Built {
        model,
        velocity,
        span,
        probes,
        body_of_block,
    })
}

fn blocks(loaded: &LoadedScene, mesh: &ValidMesh) -> Result<Vec<Box<dyn Block>>, SceneError> {
    let scene = &loaded.scene;
    let mut blocks = Vec::new();
    for (index, (name, body)) in scene.bodies.iter().enumerate() {
        let path = format!("materials.{}", body.material);
        let Some(material) = scene.materials.get(&body.material) else {
            return Err(loaded.refuse(&path, "does not exist"));
        };
        let law = (material.law.build()).map_err(|e| loaded.refuse(&path, e.message))?;
        let block = law.block(mesh, index, material.density, body.dilatation);
        blocks.push(block.map_err(|error| match error {
            FeError::Unprojectable { .. } => {
                loaded.refuse(&format!("bodies.{name}.dilatation"), error.to_string())
            }
            error => loaded.refuse(&path, error.to_string()),
        })?);
    }
    Ok(blocks)
}

fn supports(loaded: &LoadedScene, mesh: &Mesh) -> Result<Vec<Dirichlet>, SceneError> {
    let scene = &loaded.scene;
    let one = |(name, given): (&String, &spec::Prescribed)| {
        let path = format!("motions.{name}");
        let nodes = mesh
            .node_set(&given.nodes)
            .map_err(|e| loaded.refuse(&format!("{path}.nodes"), e.to_string()))?;
        let motion = motion(&given.motion)
            .map_err(|e| loaded.refuse(&format!("{path}.motion"), e.to_string()))?;
        Ok(Dirichlet::clamped(name, nodes.to_vec())
            .with_components(given.mask())
            .with_motion(motion))
    };
    scene.motions.iter().map(one).collect()
}

fn table(table: &spec::Table) -> Result<Table, FeError> {
    Table::new(table.points(), table.interpolation())
}

fn motion(given: &spec::Motion) -> Result<Motion, FeError> {
    let Some(([x, y, z], rotation)) = given.parts() else {
        return Ok(Motion::still());
    };
    let moved = Motion::translation([table(x)?, table(y)?, table(z)?]);
    Ok(match rotation {
        Some(r) => moved.with_rotation(Rotation::new(r.point, r.axis, table(&r.angle)?)?),
        None => moved,
    })
}

fn loads(
    loaded: &LoadedScene,
    solid: &Solid,
    mass: &fe_core::MassMatrix,
) -> Result<Vec<Load>, SceneError> {
    let mesh = solid.mesh();
    let one = |(name, load): (&String, &spec::Load)| {
        let refuse = |e: String| loaded.refuse(&format!("loads.{name}"), e);
        match load {
            spec::Load::Gravity(acceleration) => {
                let factor = Table::constant(1.0);
                let gravity = Gravity::new(*acceleration, factor.clone());
                let forces = gravity
                    .nodal_forces(mass)
                    .map_err(|e| refuse(e.to_string()))?;
                Ok(Load::new(forces, factor))
            }
            spec::Load::Traction {
                facets,
                traction,
                factor,
            } => {
                let facets = mesh
                    .facet_set(facets)
                    .map_err(|e| refuse(e.to_string()))?
                    .to_vec();
                let factor = table(factor).map_err(|e| refuse(e.to_string()))?;
                let load = DeadTraction::new(facets, *traction, factor.clone());
                let forces = load.nodal_forces(mesh).map_err(|e| refuse(e.to_string()))?;
                Ok(Load::new(forces, factor))
            }
        }
    };
    loaded.scene.loads.iter().map(one).collect()
}

fn interfaces(loaded: &LoadedScene, mesh: &Mesh) -> Result<Vec<Interface>, SceneError> {
    let one = |(name, given): (&String, &spec::Interface)| {
        let built = interface(mesh, name, given)
            .map_err(|e| loaded.refuse(&format!("interfaces.{name}"), e))?;
        // The detector asks again, for models made in code; here the fault has its place in the scene.
        built
            .validate(mesh.points.len(), mesh.dim)
            .map_err(|e| loaded.refuse(&format!("interfaces.{name}"), e.to_string()))?;
        Ok(built)
    };
    loaded.scene.interfaces.iter().map(one).collect()
}

fn interface(mesh: &Mesh, name: &str, given: &spec::Interface) -> Result<Interface, String> {
    let text = |e: FeError| e.to_string();
    let surface = |set: &str| {
        let facets = mesh.facet_set(set).map_err(|e| e.to_string())?;
        Surface::new(facets.to_vec()).map_err(text)
    };
    let slave = surface(&given.slave)?;
    let area = slave.tributary_areas(mesh);
    let mut reach = facet_size(&slave, mesh);
    let master = match given.master.side() {
        Side::Deformable(set) => {
            let master = surface(set)?;
            reach = reach.max(facet_size(&master, mesh));
            Master::Surface(master)
        }
        Side::Rigid(shape) => {
            let obstacle = Obstacle::new(shape, motion(&given.motion).map_err(text)?);
            Master::Obstacle(obstacle.map_err(|e| e.to_string())?)
        }
    };
    let sizes = (reach / OUT_OF_PROPORTION)..=(reach * OUT_OF_PROPORTION);
    if let Some(far) = given.search_distance.filter(|far| !sizes.contains(far)) {
        return Err(format!(
            "search_distance = {far:e} m is out of proportion: from {:e} to {:e} m are allowed where facets are up to {reach:e} m \
             large",
            sizes.start(),
            sizes.end()
        ));
    }
    let adhesion = given.adhesion.as_ref().map(adhesion);
    if let Some(bonds) = given.adhesion.filter(|bonds| bonds.normal_stiffness > 0.0) {
        reach = reach.max(BOND_REACH * (bonds.energy / bonds.normal_stiffness).sqrt());
    }
    let reach = given.search_distance.unwrap_or(reach);
    let interface = Interface::new(name, slave.nodes.clone(), area, master, reach);
    Ok(interface
        .with_friction(given.mu)
        .with_restitution(given.restitution)
        .with_rim_tolerance(RIM_LEDGE)
        .with_adhesion(adhesion))
}

/// Search distances beyond this multiple of the size of facets, or below its inverse, are slips.
const OUT_OF_PROPORTION: f64 = 1e6;
/// How far bonds are followed, in lengths `sqrt(w / C_n)` at which they start to break \[-\].
const BOND_REACH: f64 = 10.0;

fn adhesion(given: &spec::Adhesion) -> Adhesion {
    let [first, second] = given.tangential_stiffness.pair();
    Adhesion::new(given.normal_stiffness, first, given.energy, given.viscosity)
        .with_tangential_stiffness([first, second])
        .with_threshold(given.threshold)
        .with_healing_gap(given.healing_gap)
        .with_initial(given.initial)
        .with_healing(given.healing)
        .with_reference(given.reference)
        .with_update(given.update)
        .with_bonded_friction(given.bonded_friction)
}

/// How far a node may overhang the rim of a deformable master, as a part of a facet \[-\]. Bodies with flush sides
/// bulge a little differently while Newton iterates; a contact that came and went with that would never settle. Wider
/// than [`contact_bipotential::RIM_ROUND_OFF`], the default of interfaces, which is for sides that stay flush.
const RIM_LEDGE: f64 = 1e-2;

/// Longest distance between two nodes of a facet \[m\]: how far contacts are looked for.
fn facet_size(surface: &Surface, mesh: &Mesh) -> f64 {
    let distance = |a: u32, b: u32| {
        let (a, b) = (mesh.points[a as usize], mesh.points[b as usize]);
        (a - b).norm()
    };
    let pairs = surface.facets.iter().flat_map(|f| {
        f.nodes()
            .iter()
            .flat_map(|a| f.nodes().iter().map(|b| (*a, *b)))
    });
    pairs.map(|(a, b)| distance(a, b)).fold(0.0, f64::max)
}

fn scheme(scene: &Scene) -> Scheme {
    let time = &scene.time;
    Scheme::dynamic(time.theta, time.xi)
        .with_inertia(time.inertia)
        .with_contact(time.contact)
}

fn settings(scene: &Scene) -> Settings {
    let (given, default) = (&scene.solver, Settings::default());
    let newton_tolerance = given.newton_tolerance.unwrap_or(default.newton_tolerance);
    let newton_iterations = given.max_newton.unwrap_or(default.newton_iterations);
    let contact_tolerance = given.contact_tolerance.unwrap_or(default.contact_tolerance);
    let contact_iterations = given
        .max_contact_iterations
        .unwrap_or(default.contact_iterations);
    let smallest_step = scene.time.min_dt.map(|dt| dt / scene.time.dt);
    default
        .with_newton_tolerance(newton_tolerance)
        .with_newton_iterations(newton_iterations)
        .with_contact_tolerance(contact_tolerance)
        .with_contact_iterations(contact_iterations)
        .with_smallest_step(smallest_step.unwrap_or(default.smallest_step))
}

fn probes(loaded: &LoadedScene, mesh: &Mesh, first_node: &[usize]) -> Result<Vec<u32>, SceneError> {
    let scene = &loaded.scene;
    let nearest = |(name, probe): (&String, &spec::Probe)| {
        let body = scene.bodies.get_index_of(&probe.body).unwrap_or(0);
        let distance = |n: &usize| (mesh.points[*n] - Vector3::from(probe.node)).norm();
        let nodes = first_node[body]..first_node[body + 1];
        let node = nodes.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let node = node.unwrap_or(0);
        let (off, cell) = (distance(&node), cell_size(mesh, node as u32));
        if off > cell {
            let message = format!(
                "lies {off:e} m from the nearest node of body `{}`, farther than a cell there is large ({cell:e} m); that node \
                 is at ({}, {}, {})",
                probe.body, mesh.points[node].x, mesh.points[node].y, mesh.points[node].z
            );
            return Err(loaded.refuse(&format!("output.probes.{name}.node"), message));
        }
        Ok(node as u32)
    };
    scene.output.probes.iter().map(nearest).collect()
}

/// Longest distance from a node to another one of its cells \[m\].
fn cell_size(mesh: &Mesh, node: u32) -> f64 {
    let cells = mesh
        .blocks
        .iter()
        .flat_map(|block| block.cells.chunks_exact(block.kind.node_count()));
    let around = cells.filter(|cell| cell.contains(&node)).flatten();
    let far = around.map(|&n| (mesh.points[n as usize] - mesh.points[node as usize]).norm());
    far.fold(0.0, f64::max)
}
