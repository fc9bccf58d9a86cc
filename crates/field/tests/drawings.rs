//! Figures that are drawn elsewhere: letters, paths, pictures.

mod common;

use common::Random;
use freikugel_field::shapes::*;
use freikugel_field::{Extent, Field, Program, Structure, analyse, extent};
use glam::DVec3;

fn program(field: &Field) -> Program {
    Structure::compile(std::slice::from_ref(field)).expect("a sound field").program(DVec3::ZERO)
}

/// The box of a figure, with some height.
fn reach(figure: Field) -> freikugel_field::Aabb {
    match extent(&figure.extrude(1.0)) {
        Extent::Finite(aabb) => aabb,
        other => panic!("{other:?}"),
    }
}

#[test]
fn letters_have_their_holes_and_stand_side_by_side() {
    let value = |field: &Field, x: f64, y: f64| program(field).value(DVec3::new(x, y, 0.0));
    // A ring, with its middle half as high as small letters are.
    let ring: Field = text(1.0, "o").into();
    let aabb = reach(ring.clone());
    let middle = aabb.center();
    assert!(value(&ring, middle.x, middle.y) > 0.1, "the hole is outside");
    assert!(value(&ring, aabb.min.x + 0.03, middle.y) < 0.0, "the ring is inside");
    assert!((0.5..0.6).contains(&aabb.size().y) && aabb.min.y > -0.02, "{aabb:?}");
    // A dot and a stroke are two lines.
    let i: Field = text(2.0, "i").into();
    let stroke = reach(i.clone());
    let x = stroke.center().x;
    assert!(value(&i, x, 0.5) < 0.0 && value(&i, x, 1.2) > 0.0 && value(&i, x, stroke.max.y - 0.05) < 0.0);
    // Capitals of a font of size 1 are 0.714 high.
    assert!((reach(text(1.0, "H").into()).max.y - 0.714).abs() < 1e-3);
    // V tucks under A; in the other font size all is larger.
    let width = |size: f64, letters: &str| reach(text(size, letters).into()).size().x;
    assert!(width(1.0, "AV") < width(1.0, "AH") - 0.05, "{} {}", width(1.0, "AV"), width(1.0, "AH"));
    assert!((width(3.0, "AV") - 3.0 * width(1.0, "AV")).abs() < 2e-3);
    // Lines end, are centred, or begin on the y axis, one below the other.
    for (align, share) in [(0, 0.0), (1, 0.5), (2, 1.0)] {
        let lines = reach(text(1.0, "HHH\nH").with("align", &[align.into()]).into());
        let place = -lines.min.x / lines.size().x;
        assert!((place - share).abs() < 0.05, "{place}, not {share}");
        assert!((-1.4..-1.3).contains(&lines.min.y), "{lines:?}");
    }
    for (field, message) in [(text(1.0, "a\u{4e2d}"), "has no letter '中'"), (text(1.0, "  "), "shows nothing")] {
        let (analysis, diagnostics) = analyse(&field.into());
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{diagnostics:?}");
    }
}

#[test]
fn paths_are_the_figures_that_their_data_says() {
    let mut random = Random::new(41);
    let path = |data: &str| -> Field { svg_path(data).into() };
    let ellipse_arc = "M-0.8 0 A0.8 0.8 0 0 1 0.8 0 A0.8 0.8 0 0 1 -0.8 0 Z";
    for (name, made, known, tolerance) in [
        ("a square", path("m-1-1h2v2h-2z"), Field::from(rectangle(2.0, 2.0)), 1e-12),
        ("a circle", path(ellipse_arc), circle(0.8).into(), 4e-4),
        (
            "a square with a hole that runs the other way",
            path("M-1 -1 H1 V1 H-1 Z M-0.5 -0.5 V0.5 H0.5 V-0.5 Z"),
            outline([
                vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
                vec![[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]],
            ])
            .into(),
            1e-12,
        ),
        (
            "one that runs the same way, which is none",
            path("M-1 -1 H1 V1 H-1 Z M-0.5 -0.5 H0.5 V0.5 H-0.5 Z"),
            rectangle(2.0, 2.0).into(),
            1e-12,
        ),
        (
            "but is one where lines are counted",
            svg_path("M-1 -1 H1 V1 H-1 Z M-0.5 -0.5 H0.5 V0.5 H-0.5 Z").with("rule", &[1.into()]).into(),
            path("M-1 -1 H1 V1 H-1 Z M-0.5 -0.5 V0.5 H0.5 V-0.5 Z"),
            1e-12,
        ),
        ("y leads up", path("M0 0 L1 0 L0 -1 Z"), polygon([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).into(), 1e-12),
    ] {
        let (one, other) = (program(&made), program(&known));
        for p in (0..400).map(|_| random.point(1.6)) {
            let (found, expected) = (one.value(p), other.value(p));
            assert!((found - expected).abs() < tolerance, "{name} at {p}: {found}, not {expected}");
        }
    }
    for (data, message) in [("M0 0 L1 x", "is no path data"), ("M0 0 L1 1", "surrounds nothing"), ("", "needs `d`")] {
        let (analysis, diagnostics) = analyse(&path(data));
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{data}: {diagnostics:?}");
    }
}

/// The font that comes along, as if it were another one.
const FONT: &[u8] = include_bytes!("../assets/NotoSans-Regular.ttf");

#[test]
fn another_font_is_read_from_its_file() {
    let letters = text(1.3, "Äfg\nAV").with("align", &[2.into()]);
    let (own, read) = (program(&letters.clone().into()), program(&letters.in_font(FONT).expect("a font").into()));
    let mut random = Random::new(43);
    for p in (0..200).map(|_| random.point(2.0)) {
        assert_eq!(own.value(p), read.value(p), "{p}");
    }
    for (letters, contents, fault) in [
        ("a", &b"no font"[..], "is no TrueType or OpenType font"),
        ("a\u{4e2d}", FONT, "has no letter '中'"),
        (" ", FONT, "shows nothing"),
    ] {
        let error = text(1.0, letters).in_font(contents).expect_err(fault);
        assert!(error.contains(fault), "{error}");
    }
}

#[test]
fn accents_stand_on_their_letters() {
    // The accent is a letter of its own in the text, and none of its own width in the line.
    let (plain, joined, apart) = (reach(text(1.0, "e").into()), reach(text(1.0, "é").into()), "e\u{301}");
    let apart = reach(text(1.0, apart).into());
    assert!(joined.max.y > plain.max.y + 0.1);
    assert!((apart.max - joined.max).length() < 0.02, "{apart:?} and {joined:?}");
}

#[test]
fn pictures_are_as_large_as_they_are_asked_to_be() {
    let picture = |inner: &str| svg(&format!("<svg xmlns='http://www.w3.org/2000/svg'>{inner}</svg>"));
    let mut random = Random::new(47);
    let own = picture("<rect x='3' y='1' width='4' height='2'/>");
    for (name, made, known, tolerance) in [
        ("as it is", own.clone().with("center", &[0.into()]).into(), rectangle(4.0, 2.0).at([5.0, -2.0, 0.0]), 1e-6),
        ("in the middle", own.clone().into(), rectangle(4.0, 2.0).into(), 1e-6),
        ("of some height", own.with("height", &[1.into()]).into(), rectangle(2.0, 1.0).into(), 1e-6),
        (
            "strokes that cross",
            picture("<path d='M0 1H2M1 0V2' stroke='black' stroke-width='0.4'/>").into(),
            cross(2.0, 0.4).into(),
            1e-6,
        ),
        (
            "circles that overlap",
            picture("<circle r='1'/><circle r='1' cx='1'/>").into(),
            circle(1.0).at([-0.5, 0.0, 0.0]) | circle(1.0).at([0.5, 0.0, 0.0]),
            // Outside; a union knows less of the inside.
            2e-3,
        ),
    ] {
        let (one, other) = (program(&made), program(&known));
        for p in (0..400).map(|_| random.point(3.0)) {
            let (found, expected) = (one.value(p), other.value(p));
            let is_near = (found - expected).abs() < tolerance || (tolerance > 1e-3 && expected < 0.0 && found < 0.0);
            assert!(is_near, "{name} at {p}: {found}, not {expected}");
        }
    }
    for (inner, message) in
        [("", "draws nothing"), ("<text>a</text>", "`picture` of `svg` has a text"), ("<g", "is no SVG")]
    {
        let (analysis, diagnostics) = analyse(&picture(inner).into());
        assert!(analysis.is_none() && diagnostics[0].message.contains(message), "{inner}: {diagnostics:?}");
    }
}
