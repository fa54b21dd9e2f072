//! FCLib `.hdf5`, local (`W`, `q`) and global (`M`, `H`, `f`, `w`) form.

use std::path::Path;

use contact_bipotential::{Cone, ContactProblem, Delassus, GlobalProblem, SparseEntries};
use hdf5_reader::{Hdf5File, OpenOptions};

use super::{FclibError, LARGEST_SIZE, normal_last, turned, turned_entries};

/// How far deflate shrinks at best \[-\], 1032 : 1 (zlib, technical details): a data set that claims to be longer than
/// that was never written.
const BEST_DEFLATE: u64 = 1032;

/// Parses the bytes of a file; `path` is only for messages.
///
/// # Errors
/// [`FclibError::Dataset`] naming the dataset, [`FclibError::Problem`] for numbers that make no problem.
pub(super) fn parse(path: &Path, bytes: Vec<u8>) -> Result<ContactProblem, FclibError> {
    let length = bytes.len();
    let options = OpenOptions::default().with_max_read_bytes(size_of::<f64>() * LARGEST_SIZE);
    let file = Hdf5File::from_vec_with_options(bytes, options).map_err(|e| FclibError::File {
        path: path.to_owned(),
        reason: e.to_string(),
    })?;
    let source = Source { path, file, length };
    if source.file.group("/fclib_local").is_ok() {
        local(&source)
    } else if source.file.group("/fclib_global").is_ok() {
        global(&source)
    } else {
        Err(source.error(
            "/",
            "neither /fclib_local nor /fclib_global is there".to_owned(),
        ))
    }
}

fn local(source: &Source<'_>) -> Result<ContactProblem, FclibError> {
    let dim = source.dimension("/fclib_local")?;
    let mu = source.reals("/fclib_local/vectors/mu")?;
    let q = source.reals("/fclib_local/vectors/q")?;
    let mut w = source.matrix("/fclib_local/W")?;
    let (contacts, size) = (mu.len(), mu.len() * dim);
    source.expect("/fclib_local/W/m", w.rows, size)?;
    source.expect("/fclib_local/W/n", w.columns, size)?;
    source.expect("/fclib_local/vectors/q", q.len(), size)?;
    turned_entries(&mut w.entries, dim);
    let cone = Cone::from_dim(dim).map_err(|e| source.problem(e))?;
    let w = Delassus::from_entries(contacts, dim, &w.entries).map_err(|e| source.problem(e))?;
    ContactProblem::new(w, turned(&q, dim), mu, cone).map_err(|e| source.problem(e))
}

fn global(source: &Source<'_>) -> Result<ContactProblem, FclibError> {
    let dim = source.dimension("/fclib_global")?;
    let mu = source.reals("/fclib_global/vectors/mu")?;
    let w = source.reals("/fclib_global/vectors/w")?;
    let f = source.reals("/fclib_global/vectors/f")?;
    let m = source.matrix("/fclib_global/M")?;
    let mut h = source.matrix("/fclib_global/H")?;
    let size = mu.len() * dim;
    source.expect("/fclib_global/H/n", h.columns, size)?;
    source.expect("/fclib_global/H/m", h.rows, f.len())?;
    source.expect("/fclib_global/M/m", m.rows, f.len())?;
    source.expect("/fclib_global/M/n", m.columns, f.len())?;
    source.expect("/fclib_global/vectors/w", w.len(), size)?;
    for e in &mut h.entries {
        e.1 = normal_last(e.1, dim);
    }
    let cone = Cone::from_dim(dim).map_err(|e| source.problem(e))?;
    let problem = GlobalProblem::new(m, h, f, turned(&w, dim), mu, cone);
    problem.reduce().map_err(|e| source.problem(e))
}

struct Source<'a> {
    path: &'a Path,
    file: Hdf5File,
    length: usize,
}

impl Source<'_> {
    fn error(&self, dataset: &str, reason: String) -> FclibError {
        FclibError::Dataset {
            path: self.path.to_owned(),
            dataset: dataset.to_owned(),
            reason,
        }
    }

    fn problem(&self, source: contact_bipotential::ContactError) -> FclibError {
        FclibError::Problem {
            path: self.path.to_owned(),
            source,
        }
    }

    fn expect(&self, dataset: &str, found: usize, expected: usize) -> Result<(), FclibError> {
        if found == expected {
            return Ok(());
        }
        Err(self.error(
            dataset,
            format!("{found} where the rest of the file asks for {expected}"),
        ))
    }

    fn read<T: hdf5_reader::H5Type>(&self, name: &str) -> Result<Vec<T>, FclibError> {
        let said = |e: hdf5_reader::error::Error| self.error(name, e.to_string());
        let dataset = self.file.dataset(name).map_err(said)?;
        let count = dataset.num_elements().map_err(said)?;
        if count > LARGEST_SIZE as u64 || count > BEST_DEFLATE * self.length as u64 {
            return Err(self.error(
                name,
                format!("{count} numbers in a file of {} bytes", self.length),
            ));
        }
        Ok(dataset
            .read_array::<T>()
            .map_err(said)?
            .into_iter()
            .collect())
    }

    fn reals(&self, name: &str) -> Result<Vec<f64>, FclibError> {
        let values = self.read::<f64>(name)?;
        match values.iter().position(|x| !x.is_finite()) {
            Some(k) => Err(self.error(
                name,
                format!("entry {k} is {}: every number must be finite", values[k]),
            )),
            None => Ok(values),
        }
    }

    fn integer(&self, name: &str) -> Result<i64, FclibError> {
        match self.read::<i32>(name)?.as_slice() {
            [value] => Ok(i64::from(*value)),
            other => Err(self.error(name, format!("{} numbers where one is needed", other.len()))),
        }
    }

    fn size(&self, name: &str) -> Result<usize, FclibError> {
        let value = self.integer(name)?;
        match usize::try_from(value) {
            Ok(n) if n <= LARGEST_SIZE => Ok(n),
            _ => Err(self.error(name, format!("{value} lies outside of 0..={LARGEST_SIZE}"))),
        }
    }

    fn dimension(&self, group: &str) -> Result<usize, FclibError> {
        let name = format!("{group}/spacedim");
        let dim = self.size(&name)?;
        if (1..=3).contains(&dim) {
            Ok(dim)
        } else {
            Err(self.error(&name, format!("dimension {dim}: give 1, 2 or 3")))
        }
    }

    fn indices(&self, name: &str) -> Result<Vec<usize>, FclibError> {
        let values = self.read::<i32>(name)?;
        if let Some(k) = values.iter().position(|x| *x < 0) {
            return Err(self.error(name, format!("entry {k} is {}", values[k])));
        }
        Ok(values.iter().map(|x| *x as usize).collect())
    }

    /// `nz = -1`: compressed columns, `-2`: compressed rows, otherwise triplets with `i` the row and `p` the column.
    fn matrix(&self, group: &str) -> Result<SparseEntries, FclibError> {
        let at = |name: &str| format!("{group}/{name}");
        let (rows, columns, nz) = (
            self.size(&at("m"))?,
            self.size(&at("n"))?,
            self.integer(&at("nz"))?,
        );
        let (p, i, x) = (
            self.indices(&at("p"))?,
            self.indices(&at("i"))?,
            self.reals(&at("x"))?,
        );
        let entries: Vec<(usize, usize, f64)> = match nz {
            -1 => self
                .compressed(&at("p"), &p, &i, &x, columns)?
                .map(|(line, k)| (i[k], line, x[k]))
                .collect(),
            -2 => self
                .compressed(&at("p"), &p, &i, &x, rows)?
                .map(|(line, k)| (line, i[k], x[k]))
                .collect(),
            0.. => {
                let count = nz as usize;
                if count > p.len() || count > i.len() || count > x.len() {
                    return Err(self.error(&at("nz"), format!("{count} entries, fewer are stored")));
                }
                (0..count).map(|k| (i[k], p[k], x[k])).collect()
            }
            _ => return Err(self.error(&at("nz"), format!("{nz}: -1, -2 or a count is needed"))),
        };
        if let Some(e) = entries.iter().find(|e| e.0 >= rows || e.1 >= columns) {
            return Err(self.error(
                &at("i"),
                format!(
                    "entry ({}, {}) lies outside of {rows} x {columns}",
                    e.0, e.1
                ),
            ));
        }
        Ok(SparseEntries::new(rows, columns, entries))
    }

    /// Pairs of line and position of every stored entry.
    fn compressed<'p>(
        &self,
        name: &str,
        p: &'p [usize],
        i: &[usize],
        x: &[f64],
        lines: usize,
    ) -> Result<impl Iterator<Item = (usize, usize)> + 'p, FclibError> {
        self.expect(name, p.len(), lines + 1)?;
        let stored = i.len().min(x.len());
        if p[0] != 0 || p[lines] > stored || p.windows(2).any(|w| w[0] > w[1]) {
            return Err(self.error(
                name,
                format!("pointers do not rise from 0 to at most the {stored} entries stored"),
            ));
        }
        Ok((0..lines).flat_map(move |line| (p[line]..p[line + 1]).map(move |k| (line, k))))
    }
}
