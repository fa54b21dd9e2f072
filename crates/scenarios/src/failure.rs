//! Errors that end the program, with the lines of the scene.

use std::io::IsTerminal as _;
use std::ops::Range;

use miette::{GraphicalReportHandler, GraphicalTheme};
use scenarios::spec::{SceneError, Source};

/// An error that ends the program.
pub(crate) enum Failure {
    Scene(Box<SceneError>),
    /// A combination of a sweep, and what is wrong with it.
    Combination(String, Box<SceneError>),
    Other(String),
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Failure::Scene(Box::new(error))
    }
}

impl Failure {
    /// The error, with the lines of the scene when it has a place.
    pub(crate) fn text(&self) -> String {
        let (which, error) = match self {
            Failure::Scene(error) => ("", error),
            Failure::Combination(which, error) => (which.as_str(), error),
            Failure::Other(text) => return format!("error: {text}\n"),
        };
        let mut text = format!("error: {which}{error}\n");
        let Some(places) = Places::of(error) else {
            return text;
        };
        let colors = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
        let theme = if colors {
            GraphicalTheme::unicode()
        } else {
            GraphicalTheme::unicode_nocolor()
        };
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_context_lines(1)
            .with_wrap_lines(false);
        // The sentences stand above; the picture shows the places only.
        let mut picture = String::new();
        if handler.render_report(&mut picture, &places).is_ok() {
            text += picture.trim_start_matches('\n');
        }
        text
    }
}

/// The places of an error without its sentences.
#[derive(Debug)]
struct Places {
    /// The scene with its long lines cut.
    source: Source,
    labels: Vec<miette::LabeledSpan>,
}

impl Places {
    /// `None` for an error that has no place.
    fn of(error: &SceneError) -> Option<Places> {
        let SceneError::Faults {
            faults,
            source_text,
        } = error
        else {
            return None;
        };
        let spans: Vec<Range<usize>> = faults.iter().map(|fault| fault.span.clone()).collect();
        let mut source = source_text.clone();
        let (text, spans) = narrow(&source.text, &spans);
        source.text = text;
        let labels = faults.iter().zip(spans).map(|(fault, span)| {
            let words = if fault.value.is_empty() {
                "here"
            } else {
                "this value"
            };
            miette::LabeledSpan::new(Some(words.into()), span.start, span.len())
        });
        Some(Places {
            labels: labels.collect(),
            source,
        })
    }
}

impl std::fmt::Display for Places {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.labels.len() {
            1 => f.write_str("1 fault in the scene"),
            count => write!(f, "{count} faults in the scene"),
        }
    }
}

impl std::error::Error for Places {}

impl miette::Diagnostic for Places {
    fn source_code(&self) -> Option<&dyn miette::SourceCode> {
        Some(&self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = miette::LabeledSpan> + '_>> {
        Some(Box::new(self.labels.iter().cloned()))
    }
}

/// Widest line of a scene that is shown whole \[characters\]: a terminal's, with the number of the line.
const WIDEST: usize = 100;
/// What stands before the place in a line that is cut \[characters\].
const BEFORE: usize = 30;
/// Stands for what is cut off.
const DOTS: &str = "...";

/// A text with its long lines cut around the places in them, and where the places are then. A place of several lines
/// ends with its first one.
fn narrow(text: &str, places: &[Range<usize>]) -> (String, Vec<Range<usize>>) {
    let mut cut = String::with_capacity(text.len());
    let mut moved: Vec<Range<usize>> = vec![0..0; places.len()];
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let bare = line.trim_end_matches(['\n', '\r']);
        let inside =
            |place: &Range<usize>| place.start >= start && place.start < start + line.len();
        let first = places.iter().find(|place| inside(place));
        let kept = window(bare, first.map_or(0, |place| place.start - start));
        let dots = if kept.start > 0 { DOTS } else { "" };
        let shift = cut.len() + dots.len();
        for (place, moved) in places
            .iter()
            .zip(&mut moved)
            .filter(|(place, _)| inside(place))
        {
            let at = |byte: usize| shift + (byte - start).clamp(kept.start, kept.end) - kept.start;
            *moved = at(place.start)..at(place.end.min(start + bare.len()).max(place.start));
        }
        let rest = if kept.end < bare.len() { DOTS } else { "" };
        cut.extend([dots, &bare[kept.clone()], rest, &line[bare.len()..]]);
        start += line.len();
    }
    // A place behind the last line is its end.
    for (place, moved) in places.iter().zip(&mut moved) {
        if place.start >= start {
            *moved = cut.len()..cut.len();
        }
    }
    (cut, moved)
}

/// The bytes of a line that are shown when something is the matter at a byte of it.
fn window(line: &str, at: usize) -> Range<usize> {
    let starts: Vec<usize> = line.char_indices().map(|(byte, _)| byte).collect();
    if starts.len() <= WIDEST {
        return 0..line.len();
    }
    let character = starts.partition_point(|&byte| byte < at);
    let from = character.saturating_sub(BEFORE).min(starts.len() - WIDEST);
    let end = starts.get(from + WIDEST).copied().unwrap_or(line.len());
    starts[from]..end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_cut_around_what_is_wrong_in_them() {
        let long = format!("{}BAD{}", "é".repeat(500), "x".repeat(500));
        let text = format!("short\n{long}\nBAD");
        let inside = text.find("BAD").unwrap();
        let last = text.len() - 3;
        let (cut, places) = narrow(&text, &[0..5, inside..inside + 3, last..last + 3]);
        let shown: Vec<&str> = places.iter().map(|place| &cut[place.clone()]).collect();
        assert_eq!(shown, ["short", "BAD", "BAD"]);
        let widest = cut.lines().map(|line| line.chars().count()).max();
        assert_eq!(widest, Some(WIDEST + 2 * DOTS.len()));
        assert_eq!(cut.lines().count(), 3);
        // A place over all lines ends with the first, and one behind the end is the end.
        let (cut, places) = narrow(&text, &[0..text.len(), text.len()..text.len()]);
        assert_eq!(&cut[places[0].clone()], "short");
        assert_eq!(places[1], cut.len()..cut.len());
    }
}
