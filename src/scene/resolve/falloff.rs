//! `falloff` of a spotlight: a law of planar distance, and the table that is made of it [Segal 1992, 3.2].

use std::sync::Arc;

use crate::scene::settings::{Entry, Reader, Settings, SettingsError, Value};
use crate::scene::{DistanceTable, Falloff, FalloffLaw, Frustum, TableSteps};

/// Sizes of a table, the first that is fine enough.
const SIZES: [usize; 14] = [2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384];
/// Error between texels that is small enough, in codes.
const FINE: f64 = 0.5;
/// Places between two texels where the error is measured.
const PLACES: usize = 8;
/// Distances where it is measured besides, twice.
const DISTANCES: usize = 2048;
/// Rounding of a depth in window space by the shader, of which depths are up to 1.
const DEPTH_ROUNDING: f64 = 4.0 / (1 << 24) as f64;
/// Ratio of near to far below which a table has even steps of distance: steps of depth would leave one for all but the
/// nearest distances.
const EVEN_DEPTHS: f64 = 1e-3;
/// Most entries of a table.
const LONGEST: usize = 4096;

/// Makes a law of the distance that it is full at.
type MakeLaw = fn(f64) -> FalloffLaw;

const LAWS: [(&str, MakeLaw); 2] = [("inverse", FalloffLaw::Inverse), ("inverse-square", FalloffLaw::InverseSquare)];

/// Reads `falloff`, a law's name or a table of keys.
pub(super) fn read(reader: &mut Reader<'_>) -> Result<Option<FalloffLaw>, SettingsError> {
    match reader.entry("falloff").map(|entry| &entry.value) {
        None => Ok(None),
        Some(Value::String(_)) => {
            let law = reader.choice("falloff", &LAWS)?;
            Ok(law.map(|law| law(1.0)))
        }
        Some(Value::Table(table)) => keys(table).map(Some),
        Some(_) => Err(reader.error("falloff", "must be \"inverse\", \"inverse-square\" or { by = \"z\", … }")),
    }
}

fn keys(table: &Settings) -> Result<FalloffLaw, SettingsError> {
    let mut reader = table.read();
    reader.choice("by", &[("z", ())])?;
    let law = reader.choice("law", &LAWS)?;
    let full = reader.length("d0")?;
    let entries = reader.entry("table").map(|entry| distances(entry, &reader)).transpose()?;
    let law = match (law, entries) {
        (Some(law), None) => law(full.unwrap_or(1.0)),
        (None, Some(_)) if full.is_some() => return Err(reader.error("d0", "is of a `law`, not of a `table`")),
        (None, Some(entries)) => FalloffLaw::Table(entries),
        (Some(_), Some(_)) => return Err(reader.error("table", "cannot stand beside `law`: write one of them")),
        (None, None) => return Err(reader.missing("table", "[[distance, factor], …], or a `law`")),
    };
    reader.finish()?;
    Ok(law)
}

fn distances(entry: &Entry, reader: &Reader<'_>) -> Result<Vec<[f64; 2]>, SettingsError> {
    let wrong = |what: &str| reader.error("table", what);
    let shape = "must be [[distance, factor], …], 1 to 4096 of them";
    let Value::Array(items) = &entry.value else { return Err(wrong(shape)) };
    let number = |entry: &Entry| match &entry.value {
        Value::Integer(value) => Some(*value as f64),
        Value::Float(value) => Some(*value),
        _ => None,
    };
    let pair = |entry: &Entry| match &entry.value {
        Value::Array(pair) if pair.len() == 2 => Some([number(&pair[0])?, number(&pair[1])?]),
        _ => None,
    };
    let pairs: Vec<[f64; 2]> = items.iter().map(pair).collect::<Option<_>>().ok_or_else(|| wrong(shape))?;
    if pairs.is_empty() || pairs.len() > LONGEST {
        return Err(wrong(shape));
    }
    if !pairs.iter().all(|[distance, _]| *distance >= 0.0 && distance.is_finite()) {
        return Err(wrong("must have finite distances of at least 0"));
    }
    if !pairs.iter().all(|[_, factor]| (0.0..=1.0).contains(factor)) {
        return Err(wrong("must have factors in [0, 1]"));
    }
    if !pairs.is_sorted_by(|[before, _], [after, _]| before < after) {
        return Err(wrong("must have each distance above the one before"));
    }
    Ok(pairs)
}

/// Makes the table of a law between a frustum's planes: the smallest that is fine enough, of even depths if they are no worse
/// than even distances. Where neither can be, of even logarithms, which have as many steps for each power of ten; where
/// the law is a table that bends too sharply for any steps, that table itself.
pub(super) fn tabulate(law: FalloffLaw, frustum: &Frustum) -> Falloff {
    let (near, far) = (frustum.near, frustum.far);
    let kinds: &[TableSteps] = match near / far < EVEN_DEPTHS {
        true => &[TableSteps::Distance],
        false => &[TableSteps::Depth, TableSteps::Distance],
    };
    let even = finest(&law, kinds, [near, far]);
    let table = match even {
        even if even.error_codes < FINE => even,
        even => {
            let logarithmic = finest(&law, &[TableSteps::Logarithm], [near, far]);
            match &law {
                FalloffLaw::Table(pairs) if logarithmic.error_codes >= FINE => entries(pairs),
                _ if logarithmic.error_codes < even.error_codes => logarithmic,
                _ => even,
            }
        }
    };
    Falloff { law, table: Arc::new(table) }
}

/// The law's own table.
fn entries(pairs: &[[f64; 2]]) -> DistanceTable {
    let column = |k: usize| pairs.iter().map(move |pair| pair[k] as f32);
    DistanceTable { values: column(0).chain(column(1)).collect(), steps: TableSteps::Entries, error_codes: 0.0 }
}

/// The smallest table of these kinds that is fine enough, or the best.
fn finest(law: &FalloffLaw, kinds: &[TableSteps], [near, far]: [f64; 2]) -> DistanceTable {
    let steps = TableSteps::Distance;
    let mut best = DistanceTable { values: [1.0; 2].into(), steps, error_codes: f64::INFINITY };
    for (size, steps) in SIZES.into_iter().flat_map(|size| kinds.iter().map(move |steps| (size, *steps))) {
        let place = |step: usize| distance(steps, step as f64 / (size - 1) as f64, near, far);
        let values: Vec<f32> = (0..size).map(|step| unbounded(law, place(step)) as f32).collect();
        let error_codes = error_codes(law, &values, steps, near, far);
        if error_codes < best.error_codes {
            best = DistanceTable { values: values.into(), steps, error_codes };
        }
        if error_codes < FINE {
            break;
        }
    }
    best
}

/// The distance at a share of the steps.
fn distance(steps: TableSteps, share: f64, near: f64, far: f64) -> f64 {
    match steps {
        TableSteps::Distance | TableSteps::Entries => near + share * (far - near),
        TableSteps::Depth => far * near / (far - share * (far - near)),
        TableSteps::Logarithm => near * (far / near).powf(share),
    }
}

/// The share of the steps at a distance.
fn share_of(steps: TableSteps, distance: f64, near: f64, far: f64) -> f64 {
    match steps {
        TableSteps::Distance | TableSteps::Entries => (distance - near) / (far - near),
        TableSteps::Depth => (far - far * near / distance) / (far - near),
        TableSteps::Logarithm => (distance / near).ln() / (far / near).ln(),
    }
}

/// The law without its bound at 1, which the shader applies behind the lookup: a bend between two texels would need many
/// more of them.
fn unbounded(law: &FalloffLaw, distance: f64) -> f64 {
    /// The largest that is kept: a finite f32, with room for the filter.
    const MOST: f64 = 1e30;
    let value = match law {
        FalloffLaw::Table(pairs) => at_distance(pairs, distance),
        FalloffLaw::Inverse(full) => full / distance,
        FalloffLaw::InverseSquare(full) => (full / distance) * (full / distance),
    };
    value.min(MOST)
}

fn at_distance(pairs: &[[f64; 2]], distance: f64) -> f64 {
    let after = pairs.partition_point(|[at, _]| *at <= distance);
    match (pairs.get(after.wrapping_sub(1)), pairs.get(after)) {
        (Some([from, low]), Some([to, high])) => low + (high - low) * (distance - from) / (to - from),
        (Some([_, factor]), None) | (None, Some([_, factor])) => *factor,
        (None, None) => 1.0,
    }
}

/// The greatest error between two texels, with that of the rounding of a depth. It is measured within each cell, and at
/// distances that are even and at such that are even in their logarithm: a cell of depths may hold nearly all distances.
fn error_codes(law: &FalloffLaw, values: &[f32], steps: TableSteps, near: f64, far: f64) -> f64 {
    let last = values.len() - 1;
    let cells = (0..last * PLACES).map(|place| place as f64 / (last * PLACES) as f64);
    let parts = (0..=DISTANCES).map(|k| k as f64 / DISTANCES as f64);
    let distances = parts.flat_map(|part| [near + part * (far - near), near * (far / near).powf(part)]);
    let shares = cells.chain(distances.map(|distance| share_of(steps, distance, near, far)));
    let exact = |share: f64| unbounded(law, distance(steps, share.clamp(0.0, 1.0), near, far)).min(1.0);
    let errors = shares.map(|share| {
        let at = share.clamp(0.0, 1.0) * last as f64;
        let cell = (at.floor() as usize).min(last - 1);
        let (low, high) = (f64::from(values[cell]), f64::from(values[cell + 1]));
        let found = (low + (at - cell as f64) * (high - low)).min(1.0);
        let rounding = match steps {
            TableSteps::Depth => (exact(share + DEPTH_ROUNDING) - exact(share - DEPTH_ROUNDING)).abs(),
            TableSteps::Distance | TableSteps::Logarithm | TableSteps::Entries => 0.0,
        };
        (found - exact(share)).abs() + rounding
    });
    255.0 * errors.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frustum(near: f64, far: f64) -> Frustum {
        let (position, target, up) = (glam::DVec3::ZERO, glam::DVec3::NEG_Z, glam::DVec3::Y);
        Frustum { position, target, up, cone_radians: 1.0, aspect: 1.0, lean: glam::DVec2::ZERO, near, far }
    }

    /// 1/d is linear in a depth of window space: two texels hold the inverse law exactly.
    #[test]
    fn the_inverse_law_over_depth_needs_two_texels() {
        let falloff = tabulate(FalloffLaw::Inverse(0.5), &frustum(0.3, 20.0));
        assert_eq!((falloff.table.values.len(), falloff.table.steps), (2, TableSteps::Depth));
        assert!(falloff.table.error_codes < 0.01, "{}", falloff.table.error_codes);
    }

    #[test]
    fn tables_are_as_fine_as_half_a_code_or_say_by_how_much_not() {
        let bends = FalloffLaw::Table(vec![[0.5, 1.0], [2.0, 0.6], [5.0, 0.0]]);
        for (near, far) in [(0.5, 6.0), (0.01, 9.0), (1e-3, 10.0), (1e-5, 10.0), (1e-6, 1.0)] {
            for law in [bends.clone(), FalloffLaw::InverseSquare(0.5), FalloffLaw::Inverse(0.2)] {
                let table = tabulate(law.clone(), &frustum(near, far)).table;
                assert!(table.steps != TableSteps::Depth || near / far >= EVEN_DEPTHS, "{law:?} {near} {far}");
                assert!(table.error_codes < FINE, "{law:?} {near} {far}: {} codes", table.error_codes);
            }
        }
        // All of it happens within the first of even steps.
        for (near, far, full) in [(1e-5, 10.0, 1e-4), (1e-9, 1e3, 1e-7), (1e-6, 1.0, 1e-6)] {
            let table = tabulate(FalloffLaw::InverseSquare(full), &frustum(near, far)).table;
            assert_eq!(table.steps, TableSteps::Logarithm);
            assert!(table.error_codes < FINE, "{near} {far} {full}: {}", table.error_codes);
        }
        // It falls between two steps of any kind.
        let hard = tabulate(FalloffLaw::Table(vec![[4.0, 1.0], [4.000_001, 0.0]]), &frustum(0.5, 6.0)).table;
        assert_eq!((hard.steps, &hard.values[..]), (TableSteps::Entries, &[4.0, 4.000_001, 1.0, 0.0][..]));
    }
}
