//! `zelus report --picture`: the deformed model as a PNG file.

use std::path::Path;

use crate::page::press_fit;
use crate::support::{change, contents, root, run_with_report, said, scratch_copy, zelus};
use serde_json::json;

const DECK: &str = "ProjectParameters.json";

/// A picture as it was read.
struct Picture {
    width: usize,
    height: usize,
    colours: Vec<u8>,
    frames: u32,
}

impl Picture {
    fn read(path: &Path) -> Self {
        let file = std::io::BufReader::new(std::fs::File::open(path).expect("the picture"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
        let mut colours = vec![0; reader.output_buffer_size().expect("a size")];
        let frame = reader.next_frame(&mut colours).expect("a frame");
        assert_eq!((frame.color_type, frame.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
        let frames = reader.info().animation_control().map_or(1, |own| own.num_frames);
        Self { width: frame.width as usize, height: frame.height as usize, colours, frames }
    }

    fn at(&self, x: usize, y: usize) -> [u8; 3] {
        std::array::from_fn(|c| self.colours[3 * (y * self.width + x) + c])
    }

    /// Points right of the legend for which something holds.
    fn count(&self, holds: impl Fn([u8; 3]) -> bool) -> usize {
        let all = (0..self.height).flat_map(|y| (360..self.width).map(move |x| (x, y)));
        all.filter(|&(x, y)| holds(self.at(x, y))).count()
    }
}

/// Whether a colour is neither white nor grey nor black.
fn is_coloured([r, g, b]: [u8; 3]) -> bool {
    r.max(g).max(b) - r.min(g).min(b) > 40
}

/// Whether a colour is of the upper end of the map.
fn is_top([r, g, b]: [u8; 3]) -> bool {
    r > 170 && g > 180 && b < 150
}

#[test]
fn a_picture_shows_the_model_and_what_a_cut_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    press_fit().write(folder.path(), |deck| {
        let output = json!({"python_module": "vtu_output_process", "kratos_module": "KratosMultiphysics",
            "Parameters": {"model_part_name": "Structure"}});
        deck["processes"]["output"] = json!([output]);
    });
    run_with_report(folder.path(), DECK);
    let draw = |name: &str, options: &[&str]| {
        let output = zelus(folder.path(), &[&["report", "run.json", "--picture", name], options].concat());
        assert!(output.status.success() && said(&output).contains(name), "{}", said(&output));
        Picture::read(&folder.path().join(name))
    };
    let model = draw("model.png", &[]);
    assert_eq!(model.width, 1600);
    assert!(model.count(is_coloured) > model.width * model.height / 10);
    // the pressure is on the face of the hole, which a cut and a hidden pin show
    let pressure = ["--field", "CONTACT_PRESSURE"];
    let cut = draw("cut.png", &[&pressure[..], &["--cut", "z=0.75", "--view", "-0.5,-1,2"]].concat());
    assert!(cut.count(is_coloured) > 10_000, "{}", cut.count(is_coloured));
    assert!(cut.count(is_top) > 20, "{}", cut.count(is_top));
    let hidden = draw("hidden.png", &[&pressure[..], &["--hide", "Lower", "--view", "-1,-1,1"]].concat());
    assert!(hidden.count(is_top) > 5_000, "{}", hidden.count(is_top));
    // and on the pin, which is the master
    let pin = draw("pin.png", &[&pressure[..], &["--hide", "Upper", "--view", "1,1,1"]].concat());
    assert!(pin.count(is_top) > 5_000, "{}", pin.count(is_top));
    // a quarter that is mirrored twice is four times as large
    let area = |picture: &Picture| picture.count(|own| own != [255; 3]);
    let quarter = draw("quarter.png", &["--view", "z", "--factor", "0"]);
    let whole = draw("whole.png", &["--view", "z", "--factor", "0", "--mirror", "x", "--mirror", "y"]);
    // ANALYTIC: both fill the height of the picture, a quarter of the disc and the disc; 3 % for the words and lines
    let ratio = area(&whole) as f64 / area(&quarter) as f64;
    assert!((ratio - 1.0).abs() < 0.03, "{ratio}");
    let inset = draw("inset.png", &["--inset", "4"]);
    assert!(inset.at(1200, inset.height / 2) != [255; 3]);
    let steps = draw("steps.png", &["--step", "all", "--width", "800"]);
    assert_eq!((steps.width, steps.frames), (800, 3));
    assert_eq!(draw("first.png", &["--step", "0"]).count(is_top), 0);
}

/// Temperatures by resistances in a row, read from the colours of the bars and those of the legend.
#[test]
fn colours_of_a_picture_are_the_values_of_the_legend() {
    let folder = scratch_copy(&root().join("examples/bars_in_thermal_contact"));
    let output = r#""output_processes": {"vtu": [{"python_module": "vtu_output_process", "kratos_module": "KratosMultiphysics",
        "Parameters": {"model_part_name": "Bars"}}],"#;
    change(folder.path(), DECK, "\"output_processes\": {", output);
    run_with_report(folder.path(), DECK);
    let options = ["report", "run.json", "--picture", "heat.png", "--range", "0:100"];
    let output = zelus(folder.path(), &options);
    assert!(output.status.success(), "{}", said(&output));
    let picture = Picture::read(&folder.path().join("heat.png"));
    let rows: Vec<usize> = (0..picture.height).filter(|&y| is_coloured(picture.at(60, y))).collect();
    let (top, bottom) = (rows[0], rows[rows.len() - 1]);
    let temperature = |own: [u8; 3]| {
        let far = |y: usize| picture.at(60, y).iter().zip(own).map(|(&a, b)| a.abs_diff(b) as usize).sum::<usize>();
        let nearest: Vec<usize> = (top..=bottom).filter(|&y| far(y) == 0).collect();
        let middle = (nearest[0] + nearest[nearest.len() - 1]) as f64 / 2.0;
        100.0 * (bottom as f64 - middle) / (bottom - top) as f64
    };
    // the rows of the bars, and along them the colours that the legend has, so no lines of cells
    let is_known = |own: [u8; 3]| (top..=bottom).any(|y| picture.at(60, y) == own);
    let best = (0..picture.height)
        .max_by_key(|&y| (400..picture.width - 60).filter(|&x| is_known(picture.at(x, y))).count())
        .expect("a row");
    let along: Vec<f64> = (400..picture.width - 60)
        .map(|x| picture.at(x, best))
        .filter(|&own| is_coloured(own) && is_known(own))
        .map(temperature)
        .collect();
    let above = along.iter().copied().filter(|own| *own > 68.75).fold(f64::INFINITY, f64::min);
    let below = along.iter().copied().filter(|own| *own < 68.75).fold(0.0, f64::max);
    // ANALYTIC: 75 and 62.5 at the interface, 100 and 0 at the ends; colours have steps of 2.5
    for (found, exact) in [(along[0], 100.0), (above, 75.0), (below, 62.5), (along[along.len() - 1], 0.0)] {
        assert!((found - exact).abs() < 2.6, "{found} instead of {exact}");
    }
}

#[test]
fn what_a_picture_cannot_show_is_said() {
    let folder = scratch_copy(&root().join("examples/hertz_line_contact"));
    run_with_report(folder.path(), DECK);
    std::fs::write(folder.path().join("mine.png"), "mine").expect("a file");
    for (words, code, says) in [
        (&["--picture", "model.jpg"][..], 2, "let the name end in .png"),
        (&["--picture", "mine.png"], 2, "mine.png"),
        (&["--picture", "nowhere/model.png"], 4, "there is no folder nowhere"),
        (&["--picture", "model.png", "--field", "VON_MISES"], 2, "VON_MISES_STRESS"),
        (&["--picture", "model.png", "--field", "DISPLACEMENT:w"], 2, "components: size, x, y, z"),
        (&["--picture", "model.png", "--step", "9999"], 2, "the run has written the steps 0 to"),
        (&["--picture", "model.png", "--step", "last"], 2, "write a number from 0, or all"),
        (&["--picture", "model.png", "--cut", "x"], 2, "the model is in the plane"),
        (&["--picture", "model.png", "--cut", "w"], 2, "write an axis"),
        (&["--picture", "model.png", "--view", "up"], 2, "--view up is no direction"),
        (&["--picture", "model.png", "--range", "5:1"], 2, "write e.g. 0:250"),
        (&["--picture", "model.png", "--hide", "Nobody"], 2, "bodies: "),
        (&["--picture", "model.png", "--inset", "0"], 2, "it is above 0"),
        (&["--picture", "model.png", "--width", "9"], 2, "400 to 4000"),
        (&["--picture", "model.png", "-o", "page.html"], 2, "cannot be used with"),
        (&["--field", "DISPLACEMENT"], 2, "--picture <FILE.png>"),
    ] {
        let before = contents(folder.path());
        let output = zelus(folder.path(), &[&["report", "run.json"], words].concat());
        assert_eq!(output.status.code(), Some(code), "{words:?}: {}", said(&output));
        assert!(said(&output).contains(says), "{words:?}: {}", said(&output));
        assert_eq!(contents(folder.path()), before, "{words:?}");
    }
    // an own picture is replaced
    for _ in 0..2 {
        let output = zelus(folder.path(), &["report", "run.json", "--picture", "model.png"]);
        assert!(output.status.success(), "{}", said(&output));
    }
    // a run without results
    let folder = scratch_copy(&root().join("tests/cases/contact_2d/matching"));
    run_with_report(folder.path(), DECK);
    let output = zelus(folder.path(), &["report", "run.json", "--picture", "model.png"]);
    assert!(output.status.code() == Some(2) && said(&output).contains("no-results"), "{}", said(&output));
}
