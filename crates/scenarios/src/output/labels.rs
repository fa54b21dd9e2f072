//! What the columns of a history are called in pictures.

use crate::spec::Quantity;

/// Label of the axis for several columns: their quantity with its unit when it is the same.
pub(super) fn common(columns: &[String]) -> &'static str {
    let mut labels = columns.iter().map(|column| label(column));
    let first = labels.next().unwrap_or(MIXED);
    if labels.all(|label| label == first) {
        first
    } else {
        MIXED
    }
}

const MIXED: &str = "Values [SI]";

fn label(column: &str) -> &'static str {
    let words: Vec<&str> = column.split('.').collect();
    match words[..] {
        ["energy" | "work" | "dissipation" | "error", _] => "Energy [J]",
        ["contact", "penetration"] => "Penetration [m]",
        ["contact", "error"] => "Contact error [-]",
        ["contact", _] => "Contacts [-]",
        ["force", ..] => "Force [N]",
        ["moment", ..] => "Moment [N m]",
        ["bond", _, "bonded"] => "Bonded nodes [-]",
        ["bond", ..] => Quantity::Beta.label(),
        ["probe", _, name, ..] => {
            let found = Quantity::ALL.into_iter().find(|q| q.name() == name);
            found.map_or(MIXED, Quantity::label)
        }
        _ => MIXED,
    }
}

/// The columns without the words that all of them begin or end with.
pub(super) fn distinct(columns: &[String]) -> Vec<String> {
    let all: Vec<Vec<&str>> = columns.iter().map(|c| c.split('.').collect()).collect();
    let shortest = all.iter().map(Vec::len).min().unwrap_or(0);
    // Something is always left of every name.
    let shared = |pick: &dyn Fn(&Vec<&'_ str>, usize) -> String, most: usize| {
        let same = |i: usize| {
            all.windows(2)
                .all(|pair| pick(&pair[0], i) == pick(&pair[1], i))
        };
        (0..most).take_while(|&i| same(i)).count()
    };
    let front = shared(&|words, i| words[i].to_owned(), shortest.saturating_sub(1));
    let back = shared(
        &|words, i| words[words.len() - 1 - i].to_owned(),
        shortest.saturating_sub(1 + front),
    );
    if all.len() < 2 {
        return columns.to_vec();
    }
    all.iter()
        .map(|words| words[front..words.len() - back].join(" "))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(columns: &[&str]) -> Vec<String> {
        columns.iter().map(|c| (*c).to_owned()).collect()
    }

    #[test]
    fn shared_words_are_left_out() {
        let cases: &[(&[&str], &[&str])] = &[
            (&["probe.a.beta", "probe.b.beta"], &["a", "b"]),
            (&["force.top.x", "force.top.y"], &["x", "y"]),
            (
                &["probe.a.gap", "bond.a.beta_max"],
                &["probe a gap", "bond a beta_max"],
            ),
            (&["probe.a.gap"], &["probe.a.gap"]),
            (&["force.a.x", "force.a.x"], &["x", "x"]),
        ];
        for (columns, names) in cases {
            assert_eq!(distinct(&given(columns)), given(names));
        }
    }

    #[test]
    fn the_axis_says_what_all_have_in_common() {
        let label = |columns: &[&str]| common(&given(columns));
        assert_eq!(label(&["force.a.x", "force.b.y"]), "Force [N]");
        assert_eq!(label(&["probe.a.adhesion_force.x"]), "Adhesion force [N]");
        assert_eq!(
            label(&["probe.a.beta", "bond.a.beta_mean"]),
            "Intensity of adhesion [-]"
        );
        assert_eq!(label(&["force.a.x", "moment.a.x"]), MIXED);
    }
}
