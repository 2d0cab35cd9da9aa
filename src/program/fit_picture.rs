//! The picture of `zelus fit`: nominal stress over stretch, points of the data and lines of the fit, as SVG.

use std::fmt::Write as _;

use zelus_structural_mechanics::laws::{Fit, HomogeneousTest, TestData};

/// Size of the picture.
const SIZE: [f64; 2] = [760.0, 500.0];
/// Left, top, right and bottom margins of the plot.
const MARGINS: [f64; 4] = [70.0, 40.0, 20.0, 50.0];
/// Segments of a line.
const SEGMENTS: usize = 160;

/// Colour of a test.
fn colour(test: HomogeneousTest) -> &'static str {
    match test {
        HomogeneousTest::Uniaxial => "#1f5fa8",
        HomogeneousTest::Equibiaxial => "#b3401f",
        HomogeneousTest::Planar => "#2f7d3b",
    }
}

/// Round numbers between two values, about six.
fn ticks([low, high]: [f64; 2]) -> Vec<f64> {
    let rough = (high - low) / 6.0;
    let power = 10_f64.powf(rough.log10().floor());
    let step = power * [1.0, 2.0, 5.0, 10.0].into_iter().find(|m| m * power >= rough).unwrap_or(10.0);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

/// The picture as a document.
pub(super) fn picture(title: &str, fitted: &Fit, data: &[TestData]) -> String {
    let stress = |own: &TestData, stretch: f64| own.test.nominal_stress(&fitted.energy, stretch);
    let mut ranges = [[1.0_f64, 1.0_f64], [0.0, 0.0]];
    for own in data {
        for [stretch, measured] in &own.points {
            for (range, values) in ranges.iter_mut().zip([[*stretch; 2], [*measured, stress(own, *stretch)]]) {
                *range = values.iter().fold(*range, |[low, high], value| [low.min(*value), high.max(*value)]);
            }
        }
    }
    let place = |axis: usize, value: f64| {
        let [low, high] = ranges[axis];
        let share = (value - low) / (high - low).max(f64::MIN_POSITIVE);
        let (begin, end) = (MARGINS[axis], SIZE[axis] - MARGINS[axis + 2]);
        if axis == 0 { begin + share * (end - begin) } else { end - share * (end - begin) }
    };
    let [left, top, right, bottom] = [MARGINS[0], MARGINS[1], SIZE[0] - MARGINS[2], SIZE[1] - MARGINS[3]];
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<text x=\"{left}\" y=\"24\">{title}</text>\n",
        SIZE[0], SIZE[1]
    );
    for (axis, range) in ranges.iter().enumerate() {
        for tick in ticks(*range) {
            let at = place(axis, tick);
            let label = format!("{}", (tick * 1e6).round() / 1e6);
            let _ = if axis == 0 {
                writeln!(
                    out,
                    "<path d=\"M{at:.1} {top}V{bottom}\" stroke=\"#ddd\"/><text x=\"{at:.1}\" y=\"{:.1}\" \
                     text-anchor=\"middle\">{label}</text>",
                    bottom + 18.0
                )
            } else {
                writeln!(
                    out,
                    "<path d=\"M{left} {at:.1}H{right}\" stroke=\"#ddd\"/><text x=\"{:.1}\" y=\"{:.1}\" \
                     text-anchor=\"end\">{label}</text>",
                    left - 6.0,
                    at + 4.0
                )
            };
        }
    }
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">stretch</text>\n\
         <text transform=\"translate(16 {:.1}) rotate(-90)\" text-anchor=\"middle\">nominal stress</text>",
        0.5 * (left + right),
        bottom + 38.0,
        0.5 * (top + bottom)
    );
    for (row, own) in data.iter().enumerate() {
        let ink = colour(own.test);
        let ends = own.points.iter().fold([1.0_f64, 1.0_f64], |[low, high], [l, _]| [low.min(*l), high.max(*l)]);
        let points = (0..=SEGMENTS).map(|k| {
            let stretch = ends[0] + (ends[1] - ends[0]) * k as f64 / SEGMENTS as f64;
            format!("{:.1},{:.1}", place(0, stretch), place(1, stress(own, stretch)))
        });
        let line = points.collect::<Vec<_>>().join(" ");
        let _ = writeln!(out, "<polyline points=\"{line}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"1.5\"/>");
        for [stretch, measured] in &own.points {
            let (x, y) = (place(0, *stretch), place(1, *measured));
            let _ = writeln!(out, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\" fill=\"none\" stroke=\"{ink}\"/>");
        }
        let y = top + 18.0 * (row + 1) as f64;
        let _ = writeln!(
            out,
            "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3.5\" fill=\"none\" stroke=\"{ink}\"/>\
             <text x=\"{:.1}\" y=\"{y:.1}\" fill=\"{ink}\">{}</text>",
            left + 14.0,
            y - 4.0,
            left + 24.0,
            own.test.name()
        );
    }
    out + "</svg>\n"
}
