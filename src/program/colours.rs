//! Colour map of pictures: violet-blue over teal to light yellow, in even steps of perception and rising lightness.

/// Colours (sRGB) at even distances; between two of them a picture interpolates.
pub(super) const MAP: [[u8; 3]; 13] = [
    [90, 83, 180],
    [81, 102, 196],
    [70, 122, 206],
    [63, 141, 209],
    [48, 159, 206],
    [11, 177, 201],
    [22, 192, 191],
    [67, 205, 175],
    [101, 218, 162],
    [137, 229, 147],
    [175, 237, 128],
    [216, 242, 127],
    [251, 246, 138],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Lightness and two opponent colours of Oklab (Ottosson 2020), in which distances are those that the eye sees.
    fn oklab(colour: [u8; 3]) -> [f64; 3] {
        let linear = colour.map(|part| {
            let v = f64::from(part) / 255.0;
            if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
        });
        let times =
            |rows: [[f64; 3]; 3], v: [f64; 3]| rows.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum::<f64>());
        let cones = [
            [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
            [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
            [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
        ];
        let lab = [
            [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
            [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
            [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
        ];
        times(lab, times(cones, linear).map(f64::cbrt))
    }

    #[test]
    fn steps_of_the_map_look_alike_and_grow_lighter() {
        let steps: Vec<[f64; 3]> = MAP
            .windows(2)
            .map(|two| {
                let [a, b] = [oklab(two[0]), oklab(two[1])];
                std::array::from_fn(|at| b[at] - a[at])
            })
            .collect();
        let sizes: Vec<f64> = steps.iter().map(|step| step.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
        let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
        assert!(sizes.iter().all(|size| (size / mean - 1.0).abs() < 0.06), "{sizes:?}");
        assert!(steps.iter().all(|step| step[0] > 0.03), "{steps:?}");
    }
}
