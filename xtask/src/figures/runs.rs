//! What the figures take from runs.

use fe_core::CellKind;
use nscd::State;
use scenarios::Fields;
use scenarios::output::{Array, Axis, Cells, Chart, Curve, Frame, Values, deformed_svg};
use tests::compute_all;
pub(super) use tests::{Plan as Planned, Ran};

/// Curves, places and pictures of a run.
pub(super) trait Shown {
    /// A column over another.
    fn named_curve(&self, name: &str, x: &str, y: &str) -> Result<Curve, String>;
    /// Picture of the bodies at a time of the plan, coloured by the von Mises stress.
    fn deformed(&self, title: &str, index: usize) -> Result<String, String>;
    /// The same of a plane scene, and only of the elements with `|x|` and `|y|` below `near` \[m\] in the reference
    /// state.
    fn near(&self, title: &str, index: usize, near: f64) -> Result<String, String>;
    /// Reference position of the node that a probe follows \[m\].
    fn place(&self, probe: &str) -> Result<[f64; 3], String>;
}

impl Shown for Ran {
    fn named_curve(&self, name: &str, x: &str, y: &str) -> Result<Curve, String> {
        Ok(Curve::new(name, &self.column(x)?, &self.column(y)?))
    }

    fn deformed(&self, title: &str, index: usize) -> Result<String, String> {
        let state: &State = self.snapshot(index)?;
        let fields = Fields::new(&self.built, state);
        deformed_svg(title, &fields.frame(&self.built, state))
    }

    fn near(&self, title: &str, index: usize, near: f64) -> Result<String, String> {
        let state = self.snapshot(index)?;
        let fields = Fields::new(&self.built, state);
        let frame = fields.frame(&self.built, state);
        let stress = frame.cell_scalar("von_mises").unwrap_or_default();
        let shown = |node: &u32| frame.points[*node as usize].iter().all(|x| x.abs() < near);
        let mut values = stress.iter();
        let mut kept: Vec<(CellKind, Vec<u32>)> = Vec::new();
        let mut kept_stress = Vec::new();
        for cells in &frame.cells {
            let mut connectivity = Vec::new();
            let all = cells.connectivity.chunks_exact(cells.kind.node_count());
            for (cell, value) in all.zip(values.by_ref()) {
                if cell.iter().all(shown) {
                    connectivity.extend_from_slice(cell);
                    kept_stress.push(*value);
                }
            }
            kept.push((cells.kind, connectivity));
        }
        let cells = kept.iter().map(|(kind, connectivity)| Cells {
            kind: *kind,
            connectivity,
        });
        let values = Values::Scalar(&kept_stress);
        let part = Frame {
            time: frame.time,
            points: frame.points,
            cells: cells.collect(),
            point_data: frame.point_data.clone(),
            cell_data: vec![Array {
                name: "von_mises",
                values,
            }],
        };
        deformed_svg(title, &part)
    }

    fn place(&self, probe: &str) -> Result<[f64; 3], String> {
        Ok(self.built.model.solid.mesh().points[self.probed(probe)? as usize].into())
    }
}

/// A curve a run: column `y` over column `x`, named as the run.
pub(super) fn curve_each<'a>(
    runs: impl IntoIterator<Item = &'a Ran>,
    x: &str,
    y: &str,
) -> Result<Vec<Curve>, String> {
    let curves = runs
        .into_iter()
        .map(|run| run.named_curve(&run.plan.name, x, y));
    curves.collect()
}

/// Curves over time.
pub(super) fn over_time(title: &str, y: Axis, curves: Vec<Curve>) -> Chart {
    Chart::new(title, Axis::linear("Time", "s"), y, curves)
}

/// Makes all runs.
///
/// # Errors
/// The first run that cannot be made or stops before its end, with the reason.
pub(super) fn compute(plans: Vec<Planned>) -> Result<Vec<Ran>, String> {
    let told = |result: &Result<Ran, String>| match result {
        Ok(ran) => println!("  {}: {:.1} s CPU", ran.plan.name, ran.summary.cpu_s),
        Err(reason) => println!("  {reason}"),
    };
    let runs = compute_all(plans, &told);
    runs.into_iter().map(|run| run?.completed()).collect()
}
