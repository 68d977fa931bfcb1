//! Fits to measured errors: a power law, error = a · count^-p, which is a line in logarithms; and a straight line.

use serde::{Deserialize, Serialize};

/// A fitted power law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PowerFit {
    /// p in error = a · count^-p.
    pub exponent: f64,
    /// Range that holds p in 95 of 100 such fits, if errors scatter around the law by a normal distribution.
    pub range: [f64; 2],
    /// Number of points.
    pub points: usize,
}

/// Two-sided 95 % quantiles of Student's distribution for 1, 2, … degrees of freedom; beyond the last, the normal one's.
const STUDENT: [f64; 10] = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228];

/// Fits pairs of a count and an error by least squares. Pairs of which one is not above 0 have no logarithm and are left
/// out. `None`: fewer than three are left, or all counts are equal.
pub fn power_law(pairs: &[[f64; 2]]) -> Option<PowerFit> {
    let is_usable = |pair: &&[f64; 2]| pair.iter().all(|value| *value > 0.0 && value.is_finite());
    let logs: Vec<[f64; 2]> = pairs.iter().filter(is_usable).map(|pair| pair.map(f64::ln)).collect();
    let count = logs.len();
    if count < 3 {
        return None;
    }
    let (slope, reach) = slope_of(&logs)?;
    Some(PowerFit { exponent: -slope, range: [-slope - reach, -slope + reach], points: count })
}

/// A fitted straight line: y = a + slope · x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFit {
    /// Growth of y per unit of x.
    pub slope: f64,
    /// Range that holds the slope in 95 of 100 such fits, if errors scatter around the line by a normal distribution.
    pub range: [f64; 2],
}

/// Fits a straight line by least squares. `None`: fewer than three pairs, or all x are equal.
pub fn line(pairs: &[[f64; 2]]) -> Option<LineFit> {
    if pairs.len() < 3 {
        return None;
    }
    let (slope, reach) = slope_of(pairs)?;
    Some(LineFit { slope, range: [slope - reach, slope + reach] })
}

/// Slope of at least three pairs, and the half width of its 95 % range.
fn slope_of(pairs: &[[f64; 2]]) -> Option<(f64, f64)> {
    let count = pairs.len();
    let mean = |k: usize| pairs.iter().map(|pair| pair[k]).sum::<f64>() / count as f64;
    let (x, y) = (mean(0), mean(1));
    let spread: f64 = pairs.iter().map(|pair| (pair[0] - x).powi(2)).sum();
    if spread <= 0.0 {
        return None;
    }
    let slope = pairs.iter().map(|pair| (pair[0] - x) * (pair[1] - y)).sum::<f64>() / spread;
    let left: f64 = pairs.iter().map(|pair| (pair[1] - y - slope * (pair[0] - x)).powi(2)).sum();
    let error = (left / (count - 2) as f64 / spread).sqrt();
    let reach = STUDENT.get(count - 3).copied().unwrap_or(1.96) * error;
    Some((slope, reach))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_without_scatter_is_found_exactly() {
        for exponent in [0.5, 0.75, 1.0, 2.0] {
            let pairs: Vec<[f64; 2]> =
                [1.0, 4.0, 16.0, 64.0, 256.0].map(|n: f64| [n, 12.5 * n.powf(-exponent)]).to_vec();
            let fit = power_law(&pairs).unwrap();
            assert!((fit.exponent - exponent).abs() < 1e-12, "{fit:?}");
            assert!((fit.range[1] - fit.range[0]).abs() < 1e-6, "{fit:?}");
        }
    }

    #[test]
    fn a_straight_line_is_found_with_its_range() {
        let fit = line(&[[0.0, 1.0], [1.0, 3.0], [2.0, 5.0]]).unwrap();
        assert!((fit.slope - 2.0).abs() < 1e-12 && fit.range[1] - fit.range[0] < 1e-9, "{fit:?}");
        // Residuals -1/3, 2/3, -1/3: their square sum 2/3 over one degree of freedom and a spread of 2.
        let fit = line(&[[0.0, 0.0], [1.0, 1.0], [2.0, 0.0]]).unwrap();
        assert!(fit.slope.abs() < 1e-12 && (fit.range[1] - 12.706 / 3.0_f64.sqrt()).abs() < 1e-9, "{fit:?}");
        assert_eq!(line(&[[0.0, 0.0], [1.0, 1.0]]), None);
        assert_eq!(line(&[[1.0, 0.0]; 3]), None);
    }

    /// Fits of scattered errors have the true exponent in their range 95 times in 100.
    #[test]
    fn the_range_holds_the_exponent_as_often_as_it_says() {
        let mut random = fastrand::Rng::with_seed(5);
        let mut normal = || {
            let (a, b): (f64, f64) = (1.0 - random.f64(), random.f64());
            (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
        };
        let rounds = 4000;
        let mut held = 0;
        for _ in 0..rounds {
            let pairs: Vec<[f64; 2]> =
                [1.0, 4.0, 16.0, 64.0, 256.0].map(|n: f64| [n, n.powf(-0.7) * (0.2 * normal()).exp()]).to_vec();
            let fit = power_law(&pairs).unwrap();
            held += usize::from((fit.range[0]..=fit.range[1]).contains(&0.7));
        }
        // Three standard deviations of a count of 4000 at 0.95 are 41.
        assert!((3759..=3841).contains(&held), "{held} of {rounds}");
    }

    #[test]
    fn too_few_points_have_no_law() {
        assert_eq!(power_law(&[[1.0, 1.0], [2.0, 0.5]]), None);
        assert_eq!(power_law(&[[1.0, 1.0], [2.0, 0.5], [4.0, 0.0]]), None);
        assert_eq!(power_law(&[[2.0, 1.0], [2.0, 0.5], [2.0, 0.6]]), None);
    }
}
