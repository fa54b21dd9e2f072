//! What a scene will take: unknowns, memory, time.

use std::fs;

use crate::spec::{Body, GridAxis, Mesh, Scene};

/// Bytes of a body for each unknown, fitted to blocks of 4e3 to 7e4 unknowns in space and 2e4 to 5e5 in the plane:
/// state, mesh and tangent, and the factor, which grows faster than the number of unknowns.
const SPACE: [f64; 2] = [1500.0, 230.0];
/// The same in the plane.
const PLANE: [f64; 2] = [1000.0, 80.0];
/// Parts of the estimate that a run takes for sure: bodies whose factors fill less than those of blocks exist.
const FOR_SURE: f64 = 0.5;
/// Seconds of a factorization over the square of the unknowns in space, over their power 3/2 in the plane.
const FACTORIZATION: [f64; 2] = [0.6e-9, 1.4e-8];
/// Seconds of a substitution for each byte of the factor, and of an iteration for each element.
const ITERATION: [f64; 2] = [2.8e-10, 1e-5];
/// Newton iterations of a usual step.
const ITERATIONS: f64 = 6.0;

/// What a run of a scene takes, without its contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Displacement unknowns, prescribed ones included \[-\].
    pub unknowns: usize,
    /// Largest use of memory \[byte\], right to a factor of about two.
    pub memory: f64,
    /// CPU time \[s\], right to a factor of about ten, one factorization a step.
    pub time: f64,
}

impl Estimate {
    /// Of all bodies of a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Estimate {
        let mut sum = Estimate {
            unknowns: scene.size().dofs,
            memory: 0.0,
            time: 0.0,
        };
        for body in scene.bodies.values() {
            let (memory, time) = of_body(body, scene.refine);
            sum.memory += memory;
            sum.time += scene.step_count() as f64 * time;
        }
        sum
    }

    /// Why a machine with so much free memory \[byte\] cannot run the scene.
    pub(crate) fn refusal(&self, free: f64) -> Option<String> {
        let least = FOR_SURE * self.memory;
        (least > free).then(|| {
            format!(
                "{} unknowns take about {} of memory, {} at the least, and {} are free; take fewer cells",
                self.unknowns,
                bytes(self.memory),
                bytes(least),
                bytes(free)
            )
        })
    }
}

/// Bytes, and seconds of a step.
fn of_body(body: &Body, refine: usize) -> (f64, f64) {
    let size = body.mesh.size(refine);
    let n = size.dofs as f64;
    let plane = body.mesh.is_plane();
    // Unknowns that a row of the factor holds, over those of a body as wide as high and deep.
    let fill = if plane {
        n.max(2.0).log2()
    } else {
        n.cbrt() * slenderness(&body.mesh)
    };
    let [each, factor] = if plane { PLANE } else { SPACE };
    let factor = factor * n * fill;
    let factorization = if plane {
        FACTORIZATION[1] * n.powf(1.5)
    } else {
        FACTORIZATION[0] * n * fill.powi(3)
    };
    let iteration = ITERATION[0] * factor + ITERATION[1] * size.elements as f64;
    (each * n + factor, factorization + ITERATIONS * iteration)
}

/// Width of the separators of a block over that of a cube with as many cells \[-\].
fn slenderness(mesh: &Mesh) -> f64 {
    let lines = |axis: &GridAxis| axis.cells().unwrap_or(1) as f64;
    let mut cells = match mesh {
        Mesh::Box(m) => m.cells.map(|n| n as f64),
        Mesh::SolidGrid(m) => [lines(&m.x), lines(&m.y), lines(&m.z)],
        _ => return 1.0,
    };
    cells.sort_by(f64::total_cmp);
    let [a, b, c] = cells;
    (a * b).sqrt() / (a * b * c).cbrt()
}

/// Memory that this process may still take \[byte\]; `None` where the system does not tell.
pub(crate) fn free_memory() -> Option<f64> {
    let system = fs::read_to_string("/proc/meminfo").ok()?;
    let line = |name: &str| {
        let mut lines = system.lines();
        let rest = lines.find_map(|line| line.strip_prefix(name))?;
        let kilobytes: f64 = rest.trim().trim_end_matches("kB").trim().parse().ok()?;
        Some(1024.0 * kilobytes)
    };
    let free = line("MemAvailable:")? + line("SwapFree:").unwrap_or(0.0);
    // The bound of a container.
    let bound = fs::read_to_string("/sys/fs/cgroup/memory.max").ok();
    let bound: Option<f64> = bound.and_then(|text| text.trim().parse().ok());
    Some(bound.map_or(free, |bound| bound.min(free)))
}

/// Bytes in words.
pub(crate) fn bytes(count: f64) -> String {
    let units = ["B", "kB", "MB", "GB", "TB", "PB"];
    let power = (count.max(1.0).log10() / 3.0).floor();
    let k = (power as usize).min(units.len() - 1);
    format!(
        "{} {}",
        significant(count / 1000_f64.powi(k as i32)),
        units[k]
    )
}

/// Two significant digits.
fn significant(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// Seconds in words.
pub(crate) fn seconds(time: f64) -> String {
    const MINUTE: f64 = 60.0;
    const HOUR: f64 = 60.0 * MINUTE;
    const DAY: f64 = 24.0 * HOUR;
    let units = [(DAY, "days"), (HOUR, "hours"), (MINUTE, "minutes")];
    let (unit, name) = units
        .into_iter()
        .find(|(unit, _)| time >= 2.0 * unit)
        .unwrap_or((1.0, "seconds"));
    format!("{} {name}", significant(time / unit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalog;

    fn block(cells: &str) -> Estimate {
        let set = format!("lower.mesh.cells={cells}").parse().unwrap();
        Estimate::of(&catalog::load("impact", &[set]).unwrap().scene)
    }

    #[test]
    fn memory_is_that_of_runs_that_were_measured() {
        // Peak of 241 MB at 27783 unknowns and of 820 MB at 73167.
        for (cells, measured) in [("(20,20,20)", 241e6), ("(28,28,28)", 820e6)] {
            let ratio = block(cells).memory / measured;
            assert!((0.6..1.6).contains(&ratio), "{cells}: {ratio}");
        }
    }

    #[test]
    fn what_fits_no_memory_is_refused_with_its_size() {
        let large = block("(220,220,220)");
        assert!(large.unknowns > 32_000_000);
        let refusal = large.refusal(1e11).unwrap();
        assert!(
            refusal.contains("TB of memory") && refusal.contains("100 GB are free"),
            "{refusal}"
        );
        assert_eq!(block("(20,20,20)").refusal(1e9), None);
        // A rod of as many cells fills its factor far less than a cube.
        assert!(block("(10,10,1000)").memory < 0.5 * block("(46,46,46)").memory);
    }

    #[test]
    fn sizes_and_times_are_told_in_words() {
        assert_eq!(bytes(2.34e12), "2.3 TB");
        assert_eq!(bytes(820e6), "820 MB");
        assert_eq!(seconds(90.0), "90 seconds");
        assert_eq!(seconds(7300.0), "2 hours");
    }
}
