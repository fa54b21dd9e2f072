//! Random contact problems: what every method claims, against the error in twice the digits.

use contact_bipotential::conformance::{drawn_problem, exact_error};
use contact_bipotential::{Method, SolveSettings, solve};
use rayon::prelude::*;

use crate::Outcome;

/// Tolerance of the solves \[-\], that of `setae contact`.
const TOLERANCE: f64 = 1e-8;
/// Error over the tolerance that the summation in twice the digits may find beyond what was claimed \[-\].
const MARGIN: f64 = 1.001;
/// False successes that are printed.
const SHOWN: usize = 20;
/// The methods: the default, and the one that trusts its Newton steps alone.
const METHODS: [Method; 2] = [Method::Auto, Method::Newton];

/// What a method made of the problems.
#[derive(Default)]
struct Count {
    solved: usize,
    /// Problems made from a solution, and those of them that were solved.
    made: usize,
    made_solved: usize,
    /// Successes that are none: number of the problem and its error.
    wrong: Vec<(u64, f64)>,
}

impl Count {
    fn of(method: Method, seed: u64, index: u64) -> Self {
        let drawn = drawn_problem(seed, index);
        let settings = SolveSettings::default()
            .with_method(method)
            .with_tolerance(TOLERANCE);
        let mut r = Vec::new();
        let solved = solve(&drawn.problem, &mut r, &settings).is_converged();
        let made = drawn.solution.is_some();
        let error = exact_error(&drawn.problem, &r);
        let wrong = solved && error > MARGIN * TOLERANCE;
        Count {
            solved: usize::from(solved),
            made: usize::from(made),
            made_solved: usize::from(made && solved),
            wrong: wrong.then_some((index, error)).into_iter().collect(),
        }
    }

    fn add(mut self, other: Count) -> Count {
        self.solved += other.solved;
        self.made += other.made;
        self.made_solved += other.made_solved;
        self.wrong.extend(other.wrong);
        self
    }
}

/// Solves so many problems and checks every success.
///
/// # Errors
/// Successes that are none.
pub(super) fn run(count: u64, seed: u64) -> Outcome {
    let mut wrong = 0;
    for method in METHODS {
        let one = |index| Count::of(method, seed, index);
        let all = (0..count).into_par_iter().map(one);
        let found = all.reduce(Count::default, Count::add);
        let share = |part: usize, whole: f64| 100.0 * part as f64 / whole.max(1.0);
        println!(
            "{}: {} of {count} solved ({:.2} %), {} of {} with a known solution ({:.2} %), {} false",
            method.name(),
            found.solved,
            share(found.solved, count as f64),
            found.made_solved,
            found.made,
            share(found.made_solved, found.made as f64),
            found.wrong.len()
        );
        for (index, error) in found.wrong.iter().take(SHOWN) {
            println!("  {index}: error {error:.1e}, {TOLERANCE:e} was claimed");
        }
        wrong += found.wrong.len();
    }
    match wrong {
        0 => Ok(()),
        count => Err(format!("{count} false successes")),
    }
}
