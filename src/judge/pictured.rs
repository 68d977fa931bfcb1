//! A shade out of two pictures by one renderer: with the light's shadow, and without.

/// Least light that a picture of 8 bits shows: half a code. Shading at 90 degrees to the light is less in one pass and none
/// in another, by the rounding of its cosine.
const LEAST_LIGHT: f32 = 0.5 / 255.0;

/// Shade of each pixel, in [0, 1]: the part of the light that a picture shows of what the same picture shows without shadow.
/// NaN where there is no light to compare; 1 for light where there should be none. `shown` and `unshadowed` are one channel's
/// values, 1 for full light, of pictures in which only the light in question shines.
pub fn shade_of_pictures(shown: impl Iterator<Item = f32>, unshadowed: impl Iterator<Item = f32>) -> Vec<f32> {
    shown.zip(unshadowed).map(|pair| seen_shade(pair).clamp(0.0, 1.0)).collect()
}

fn seen_shade((shown, unshadowed): (f32, f32)) -> f32 {
    match (shown > LEAST_LIGHT, unshadowed > LEAST_LIGHT) {
        (_, true) => shown / unshadowed,
        (true, false) => 1.0,
        (false, false) => f32::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::shade_of_pictures;

    #[test]
    fn a_shade_is_the_part_of_the_light_that_is_left() {
        let shade = shade_of_pictures(
            [0.0, 0.2, 0.4, 0.5, 0.001, 0.3].into_iter(),
            [0.4, 0.4, 0.4, 0.4, 0.001, 0.0].into_iter(),
        );
        assert_eq!(shade[..4], [0.0, 0.5, 1.0, 1.0]);
        assert!(shade[4].is_nan(), "less than half a code is no light");
        assert_eq!(shade[5], 1.0, "light where there should be none");
    }
}
