//! Names that look alike.

/// Names that look like `asked`, the nearest first; names further than about a third of the letters are left out.
pub(crate) fn near_names<'a>(
    asked: &str,
    names: impl IntoIterator<Item = &'a str>,
) -> Vec<&'a str> {
    let limit = 1 + asked.chars().count() / 3;
    let mut near: Vec<(usize, &str)> = names
        .into_iter()
        .map(|name| (distance(name, asked), name))
        .filter(|(d, _)| *d <= limit)
        .collect();
    near.sort_by_key(|(d, _)| *d);
    near.into_iter().map(|(_, name)| name).collect()
}

/// Edit distance in characters, upper and lower case the same.
pub(super) fn distance(a: &str, b: &str) -> usize {
    let [a, b] = [a, b].map(|s| s.to_lowercase().chars().collect::<Vec<_>>());
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
