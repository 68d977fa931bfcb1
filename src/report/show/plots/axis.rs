//! Logarithmic axes with ticks at plain numbers. Knows no picture.

use std::ops::Range;

/// A logarithmic axis that holds some values.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlotAxis {
    pub range: Range<f64>,
    /// Ticks with a label and a line.
    pub ticks: Vec<f64>,
    /// Ticks with a faint line.
    pub minor: Vec<f64>,
    /// Place of zeros, below the least value; `None` without zeros.
    pub floor: Option<f64>,
    /// Length of an even axis, whose values are shifted and scaled into the range's logarithms; `None`: it is logarithmic.
    pub even: Option<f64>,
}

/// Decades of a logarithmic axis that an even one takes the place of.
const DECADES: f64 = 2.0;

impl PlotAxis {
    /// An axis over values not below zero; `None` if there are none.
    pub fn over(values: impl Iterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = values.filter(|value| value.is_finite() && *value >= 0.0).collect();
        let positive = || values.iter().copied().filter(|value| *value > 0.0);
        let greatest = positive().fold(0.0, f64::max);
        let least = positive().fold(f64::INFINITY, f64::min);
        let (least, greatest) = if greatest > 0.0 { (least, greatest) } else { (0.1, 1.0) };
        let floor = values.contains(&0.0).then(|| floor_below(least));
        let range = floor.unwrap_or(least) / 1.4..1.4 * greatest;
        let lowest_tick = floor.map_or(range.start, |floor| 1.8 * floor);
        let (ticks, minor) = ticks(lowest_tick..range.end);
        let ticks = floor.into_iter().chain(ticks).collect();
        (!values.is_empty()).then_some(Self { range, ticks, minor, floor, even: None })
    }

    /// An even axis from 0 to the greatest of `values`, with a tick at each of them; `None` if none is above 0.
    pub fn even(values: &[f64]) -> Option<Self> {
        let length = values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max);
        let axis = Self {
            range: 0.8..1.25 * 10_f64.powf(DECADES),
            ticks: Vec::new(),
            minor: Vec::new(),
            floor: None,
            even: Some(length),
        };
        let mut ticks: Vec<f64> = values.iter().map(|value| axis.place(*value)).collect();
        ticks.sort_by(f64::total_cmp);
        ticks.dedup();
        (length > 0.0).then_some(Self { ticks, ..axis })
    }

    /// Value at a place of the axis.
    pub fn value(&self, place: f64) -> f64 {
        match self.even {
            // Rounded to what was placed.
            Some(length) => 1e-6 * (1e6 * length * place.log10() / DECADES).round(),
            None => place,
        }
    }

    /// An axis with a tick at each of `values`, and none between.
    pub fn at(values: &[f64]) -> Option<Self> {
        let axis = Self::over(values.iter().copied())?;
        Some(Self { ticks: values.to_vec(), minor: Vec::new(), ..axis })
    }

    /// Place of a value on the axis.
    pub fn place(&self, value: f64) -> f64 {
        match self.even {
            Some(length) => 10_f64.powf(DECADES * value / length),
            None if value > 0.0 => value,
            None => self.floor.unwrap_or(self.range.start),
        }
    }
}

/// The power of ten at least a factor of 2 below.
fn floor_below(least: f64) -> f64 {
    10_f64.powf((0.5 * least).log10().floor())
}

/// Labelled ticks and the faint ones between: powers of ten over a wide range, 1, 2, 5 or all digits over a narrow one.
fn ticks(range: Range<f64>) -> (Vec<f64>, Vec<f64>) {
    let digits: &[u32] = match (range.end / range.start).log10() {
        wide if wide > 2.3 => &[1],
        medium if medium > 0.9 => &[1, 2, 5],
        _ => &[1, 2, 3, 4, 5, 6, 7, 8, 9],
    };
    let (first, last) = (range.start.log10().floor() as i32, range.end.log10().ceil() as i32);
    let with = |digits: &[u32]| -> Vec<f64> {
        let decade = |exponent: i32| digits.iter().map(move |digit| f64::from(*digit) * 10_f64.powi(exponent));
        (first..=last).flat_map(decade).filter(|tick| range.contains(tick)).collect()
    };
    let labelled = with(digits);
    if labelled.len() >= 2 {
        return (labelled, with(&[1, 2, 3, 4, 5, 6, 7, 8, 9]));
    }
    // Narrower than one digit.
    let step = (range.end - range.start) / 4.0;
    ((1..4).map(|index| range.start + step * f64::from(index)).collect(), Vec::new())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_axis_has_powers_of_ten() {
        let axis = PlotAxis::over([0.013, 40.0].into_iter()).unwrap();
        assert_eq!(axis.ticks, [0.01, 0.1, 1.0, 10.0]);
        assert_eq!(axis.floor, None);
    }

    #[test]
    fn a_narrow_axis_has_digits() {
        assert_eq!(PlotAxis::over([4.0, 30.0].into_iter()).unwrap().ticks, [5.0, 10.0, 20.0]);
        assert_eq!(PlotAxis::over([4.0, 6.0].into_iter()).unwrap().ticks, [3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
        assert!(PlotAxis::over([4.0].into_iter()).unwrap().ticks.len() >= 2);
    }

    #[test]
    fn zeros_lie_on_a_floor_below_everything() {
        for least in [0.003, 0.01, 0.019, 0.5, 1.0] {
            let axis = PlotAxis::over([0.0, least, 7.0].into_iter()).unwrap();
            let floor = axis.floor.unwrap();
            assert!(2.0 * floor <= least && axis.range.contains(&floor), "{least}: {floor}");
            assert_eq!(axis.place(0.0), floor);
            assert_eq!(axis.place(least), least);
        }
    }

    #[test]
    fn only_zeros_and_nothing() {
        let axis = PlotAxis::over([0.0].into_iter()).unwrap();
        assert!(axis.range.contains(&axis.place(0.0)));
        assert_eq!(PlotAxis::over(std::iter::empty()), None);
    }
}
