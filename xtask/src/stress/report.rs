//! The map as Markdown, as a table of all runs, and in a few lines.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::Made;
use super::runs::{End, Found};
use super::subject::{Extreme, Law};

/// Share of the energy made up by the time integration beyond which a run is warned of, as in its summary.
const NOTABLE: f64 = 0.1;

#[derive(Default)]
struct Count {
    runs: usize,
    completed: usize,
    /// Of these with a notable error of the time integration.
    warned: usize,
    refused: usize,
    stopped: BTreeMap<&'static str, usize>,
    budget: usize,
    wrong: usize,
    energy: f64,
    law: f64,
    cpu: f64,
}

impl Count {
    fn of<'a>(made: impl Iterator<Item = &'a Made>) -> Count {
        let mut count = Count::default();
        made.for_each(|m| count.add(&m.found));
        count
    }

    fn add(&mut self, found: &Found) {
        self.runs += 1;
        self.cpu += found.cpu;
        self.energy = self.energy.max(found.worst.energy);
        self.law = self.law.max(found.worst.law.max(found.worst.contact_error));
        match &found.end {
            End::Completed => {
                self.completed += 1;
                self.warned += usize::from(found.worst.integration > NOTABLE);
            }
            End::Refused(_) => self.refused += 1,
            End::Stopped(kind, _) => *self.stopped.entry(kind).or_default() += 1,
            End::Budget => self.budget += 1,
            End::Wrong(_) => self.wrong += 1,
        }
    }

    fn stops(&self) -> usize {
        self.stopped.values().sum()
    }

    fn reasons(&self) -> String {
        let each = self.stopped.iter().map(|(kind, n)| format!("{kind} {n}"));
        each.collect::<Vec<_>>().join(", ")
    }
}

/// A few lines for the terminal.
pub(super) fn short(made: &[Made]) -> String {
    let all = Count::of(made.iter());
    format!(
        "{} runs: {} completed ({} with a notable integration error), {} refused, {} stopped ({}), {} cut, {} wrong; \
         {:.0} s CPU; worst open audit {:.1e}, worst contact error {:.1e}",
        all.runs,
        all.completed,
        all.warned,
        all.refused,
        all.stops(),
        all.reasons(),
        all.budget,
        all.wrong,
        all.cpu,
        all.energy,
        all.law
    )
}

/// One line a run.
pub(super) fn table(made: &[Made]) -> String {
    let mut text = "index;case;kind;extremes;end;steps;rejected;iterations;cpu_s;energy;residual;law;contact_error;depth;integration;reason\n".to_owned();
    for m in made {
        let (end, reason) = match &m.found.end {
            End::Completed => ("completed", ""),
            End::Refused(why) => ("refused", why.as_str()),
            End::Stopped(kind, why) => (*kind, why.as_str()),
            End::Budget => ("budget", ""),
            End::Wrong(why) => ("wrong", why.as_str()),
        };
        let (f, w) = (&m.found, &m.found.worst);
        let _ = writeln!(
            text,
            "{};{:?};{:?};{:?};{end};{};{};{};{:.3};{:.1e};{:.1e};{:.1e};{:.1e};{:.1e};{:.1e};{}",
            m.index,
            m.draw.case,
            m.draw.kind,
            m.draw.extremes,
            f.steps,
            f.rejected,
            f.iterations,
            f.cpu,
            w.energy,
            w.residual,
            w.law,
            w.contact_error,
            w.depth,
            w.integration,
            reason.replace('\n', " ")
        );
    }
    text
}

/// The page of the docs.
pub(super) fn markdown(made: &[Made], seed: u64) -> String {
    let mut text = HEAD
        .replace("{runs}", &made.len().to_string())
        .replace("{seed}", &seed.to_string());
    let _ = writeln!(text, "{TABLE}");
    let mut row = |name: &str, count: &Count| {
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {:.0e} | {:.0e} | {:.1} |",
            count.runs,
            count.completed,
            count.warned,
            count.refused,
            if count.stops() == 0 {
                "-".to_owned()
            } else {
                format!("{} ({})", count.stops(), count.reasons())
            },
            count.budget,
            count.wrong,
            count.energy,
            count.law,
            count.cpu
        );
    };
    for (extreme, name) in Extreme::ALL {
        row(
            name,
            &Count::of(made.iter().filter(|m| m.draw.extremes.contains(&extreme))),
        );
    }
    let quadratic = made.iter().filter(|m| m.draw.quadratic);
    row(
        "(quadratic elements on a rigid master)",
        &Count::of(quadratic),
    );
    let projected = made.iter().filter(|m| m.draw.projected);
    row("(projected dilatation)", &Count::of(projected));
    row("**all runs**", &Count::of(made.iter()));
    text.push_str(&tail(made));
    text
}

const HEAD: &str = "# What the numerics survive\n\n\
    Made by `cargo xtask stress`: {runs} runs drawn with seed {seed}, each with at least one thing extreme, often several.\n\
    Run `k` is the same everywhere: `cargo xtask stress --index k --write DIR` makes it alone and writes its scene. CI makes a tenth.\n\n";
const TABLE: &str = "| what is extreme | runs | completed | of these warned | refused | stopped, why | cut | wrong | open audit | contact error | CPU \\[s\\] |\n\
    |---|---:|---:|---:|---:|---|---:|---:|---:|---:|---:|";
/// What limits there are and what to do about them.
fn tail(made: &[Made]) -> String {
    let inverted = made
        .iter()
        .filter(|m| matches!(m.found.end, End::Stopped("element inverted", _)));
    let soft = |m: &&Made| matches!(m.draw.law, Law::SaintVenantKirchhoff | Law::ThreeE);
    let (all, soft) = (inverted.clone().count(), inverted.filter(soft).count());
    LIMITS
        .replace("{inverted}", &all.to_string())
        .replace("{soft}", &soft.to_string())
}

const LIMITS: &str = "\n\
A run is *completed* when it reached its end and every accepted step, recomputed from its state alone, is what it claims to be:\n\
all numbers finite; forces, inertia and reactions in balance at every node and in sum; kinetic and strain energy those of the\n\
state, and the audit of the energies closed (*open audit*: share of the largest energy or work, beyond round-off); every contact in its cone, closed\n\
where it presses, sliding against its friction (*contact error*: the larger of the recomputed and the reported one); beta in\n\
[0, 1]; no slave node deeper in its master than reported, found without the contact search, at the end or on the way. *Warned*:\n\
the time integration made up more than a tenth of the energy, which `summary.json` says too. *Stopped*: no step down to a\n\
thousandth of the given one converges, with place and advice. *Cut*: too many iterations. *Wrong* is everything else.\n\
A run counts in every row whose extreme it has.\n\n\
## Limits, and what to do about them\n\n\
- **Crushed elements.** {soft} of the {inverted} runs that stop at an inverted element have the laws Saint Venant-Kirchhoff or 3E,\n\
  which give way below a stretch near .58 and do not resist the collapse of matter: no step is short enough. Take NeoHookean or\n\
  BlatzKo where a body is crushed.\n\
- **Driven against driven** (*immovable*): where all unknowns of both sides are prescribed no force can hold them apart. The\n\
  run stops where they meet. Drive a face instead of the whole body.\n\
- **Rims.** A slave node that leaves its master over the rim is free, and one that comes and goes there with the iterations\n\
  stops the run (*rim*). Make the master larger than the slave; sides that may be touched belong to it.\n\
- **Long steps.** They converge, but the time integration makes up energy. Follow the warning, not the convergence.\n\
- **Velocity level.** Overlaps from contacts that were not foreseen are kept; `max_penetration` is the deepest of all nodes. Take shorter\n\
  steps, or use the position level.\n\
- **Bonds without viscosity** snap where they soften faster than the body follows (*snap*). Give them b > 0 or the body inertia.\n\
- **No supports.** Without inertia a body that nothing can touch is refused; one that contacts or bonds hold runs, and stops (*adrift*)\n\
  when they let go.\n\
- **Contact problems** that are not solved in the iterations allowed (2000 here, 20000 by default) cost most of the time of a\n\
  hopeless run. Lower `solver.max_contact_iterations` to fail sooner.\n\
- **Overlap** at the start is refused in dynamics where it is deeper than a hundredth of the shortest edge (it would be energy from\n\
  nothing); without inertia it is a press fit, refused only where it is deeper than `search_distance`. A contact that is lost on the way\n\
  under its master stops the run (*contact lost*), and nodes that came in through a side that is no master are told in a warning at\n\
  the end. Start closer, or give the distance.\n\
- **Self-contact** does not exist: a master that is crushed until its surface folds over itself may lose a slave in the fold.\n\
- **Round-off** of masses and damping over steps of 1e-11 s is more than 1e-8 of the forces; what it can make is not held against a run.\n\
- A scene cannot choose the method of its contact solve, so the map shows the one that the program takes.\n\n\
With `--seed` 1 to 20 beside 2026 four of 13860 runs are *wrong*, and none is *cut*: 12/83, 10/454 and 15/398 (seed/number) accept a step in\n\
which a slave lies in a fold of a crushed master or in a cell of it that is turned inside out at a corner, 8/347 one in which a slave has\n\
come round the rim under its master. All four stop in one of the next steps.\n";
