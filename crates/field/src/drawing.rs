//! SVG pictures as closed lines: everything that is drawn in them, fills and strokes, as one figure.

use crate::arcs::Lines;
use crate::fill::{Rule, common, filled};
use glam::DVec2;
use usvg::tiny_skia_path::{Path, PathSegment, Point, Transform};
use usvg::{FillRule, Group, Node, Options, Tree, roxmltree};

/// Arcs are within this share of the picture's size from its curves.
const TOLERANCE: f64 = 1e-4;

/// The closed lines of a picture, with arguments as those of an outline. In pictures y leads downwards; here it leads upwards.
///
/// # Errors
/// What is wrong with the picture, or can't be a figure, as the end of a sentence.
pub(crate) fn lines(text: &str) -> Result<Vec<f64>, String> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(text, options)
        .map_err(|error| format!("is no SVG picture: {error}"))?;
    if let Some(element) = document.descendants().find(|node| node.has_tag_name((SVG, "text"))) {
        let place = document.text_pos_at(element.range().start);
        return Err(format!("has a text (line {}); a drawing program makes paths of texts", place.row));
    }
    let tree =
        Tree::from_xmltree(&document, &Options::default()).map_err(|error| format!("is no SVG picture: {error}"))?;
    let drawn = tree.root().abs_stroke_bounding_box();
    let tolerance = f64::from(drawn.width().max(drawn.height())) * TOLERANCE;
    group(tree.root(), tolerance)
}

/// The namespace of the elements of SVG.
const SVG: &str = "http://www.w3.org/2000/svg";

/// All that is drawn in a group.
fn group(group: &Group, tolerance: f64) -> Result<Vec<f64>, String> {
    if group.mask().is_some() || !group.filters().is_empty() {
        return Err("has a mask or a filter, which figures have not".into());
    }
    let mut all = Vec::new();
    for node in group.children() {
        match node {
            Node::Group(inner) => all.extend(self::group(inner, tolerance)?),
            Node::Path(path) if path.is_visible() => all.extend(drawn(path, tolerance)),
            Node::Image(_) => return Err("has an image of pixels within, which is no figure".into()),
            Node::Path(_) | Node::Text(_) => {}
        }
    }
    // Everything has its inside on the left, so that what overlaps counts once.
    let all = filled(&all, Rule::NonZero, tolerance);
    match group.clip_path() {
        Some(clip) => Ok(common(&all, &clip_lines(clip, group.abs_transform(), tolerance)?, tolerance)),
        None => Ok(all),
    }
}

/// What a clip path leaves.
fn clip_lines(clip: &usvg::ClipPath, outer: Transform, tolerance: f64) -> Result<Vec<f64>, String> {
    let placed = outer.pre_concat(clip.transform());
    let mut all = Vec::new();
    let mut pending = vec![clip.root()];
    while let Some(group) = pending.pop() {
        for node in group.children() {
            match node {
                Node::Group(inner) => pending.push(inner),
                Node::Path(path) => all.extend(fill(path, placed, tolerance)),
                _ => {}
            }
        }
    }
    let all = filled(&all, Rule::NonZero, tolerance);
    match clip.clip_path() {
        Some(inner) => Ok(common(&all, &clip_lines(inner, outer, tolerance)?, tolerance)),
        None => Ok(all),
    }
}

/// What a path fills and strokes.
fn drawn(path: &usvg::Path, tolerance: f64) -> Vec<f64> {
    let mut all = fill(path, Transform::identity(), tolerance);
    if let Some(stroke) = path.stroke() {
        let stroke = stroke.to_tiny_skia();
        let placed = path.abs_transform();
        // The stroker is as exact as is asked for in the path's own units.
        let (x, y) = placed.get_scale();
        let resolution = x.max(y) / (4.0 * tolerance as f32);
        let dashed = stroke.dash.as_ref().and_then(|dash| path.data().dash(dash, resolution));
        let line = dashed.as_ref().unwrap_or(path.data()).stroke(&stroke, resolution);
        all.extend(line.map(|line| area(line, placed, Rule::NonZero, tolerance)).unwrap_or_default());
    }
    all
}

/// What a path fills, with its own transform within an outer one.
fn fill(path: &usvg::Path, outer: Transform, tolerance: f64) -> Vec<f64> {
    let Some(fill) = path.fill() else { return Vec::new() };
    let rule = match fill.rule() {
        FillRule::NonZero => Rule::NonZero,
        FillRule::EvenOdd => Rule::EvenOdd,
    };
    area(path.data().clone(), outer.pre_concat(path.abs_transform()), rule, tolerance)
}

/// The border of what a path surrounds.
fn area(path: Path, placed: Transform, rule: Rule, tolerance: f64) -> Vec<f64> {
    let Some(path) = path.transform(placed) else { return Vec::new() };
    let point = |p: Point| DVec2::new(p.x.into(), -f64::from(p.y));
    let mut lines = Lines::new(tolerance);
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(to) => lines.move_to(point(to)),
            PathSegment::LineTo(to) => lines.line_to(point(to)),
            PathSegment::QuadTo(control, to) => lines.quadratic_to(point(control), point(to)),
            PathSegment::CubicTo(first, second, to) => lines.cubic_to(point(first), point(second), point(to)),
            PathSegment::Close => lines.close(),
        }
    }
    filled(&lines.finish(), rule, tolerance)
}

#[cfg(test)]
mod tests {
    use super::lines;
    use crate::shapes::outline::edges;

    /// The number of edges of a picture's figure, and its extent: least and largest x and y of corners.
    fn about(inner: &str) -> (usize, [f64; 4]) {
        let text = format!(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 10 10">{inner}</svg>"#);
        let lines = lines(&text).expect(inner);
        let extent = lines.chunks(4).fold([f64::MAX, f64::MAX, f64::MIN, f64::MIN], |[a, b, c, d], p| {
            [a.min(p[0]), b.min(p[1]), c.max(p[0]), d.max(p[1])]
        });
        (edges(&lines).len(), extent)
    }

    fn is_near(a: [f64; 4], b: [f64; 4]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 3e-3)
    }

    #[test]
    fn fills_and_strokes_are_one_figure() {
        for (inner, count, extent) in [
            (r#"<rect x="1" y="2" width="3" height="4"/>"#, 4, [1.0, -6.0, 4.0, -2.0]),
            // A stroke alone is a ring around it, with a fill just larger.
            (r#"<rect x="1" y="2" width="3" height="4" fill="none" stroke="red"/>"#, 8, [0.5, -6.5, 4.5, -1.5]),
            (r#"<rect x="1" y="2" width="3" height="4" stroke="red"/>"#, 4, [0.5, -6.5, 4.5, -1.5]),
            // Ends as they are asked for.
            (r#"<path d="M2 2H6" stroke="red"/>"#, 4, [2.0, -2.5, 6.0, -1.5]),
            // With a corner on a straight edge, where the stroke began.
            (r#"<path d="M2 2H6" stroke="red" stroke-linecap="square"/>"#, 5, [1.5, -2.5, 6.5, -1.5]),
            // Two squares that overlap, moved by their group.
            (
                r#"<g transform="translate(1 1)"><rect width="2" height="2"/><rect x="1" y="1" width="2" height="2"/></g>"#,
                8,
                [1.0, -4.0, 4.0, -1.0],
            ),
            (
                r#"<clipPath id="c"><rect width="2" height="9"/></clipPath><rect clip-path="url(#c)" width="4" height="4"/>"#,
                4,
                [0.0, -4.0, 2.0, 0.0],
            ),
            // Clip paths move with what they clip, and by themselves.
            (
                r#"<clipPath id="c" transform="translate(1 0)"><rect width="2" height="9"/></clipPath>
                    <g transform="translate(3 1)"><rect clip-path="url(#c)" width="4" height="4"/></g>"#,
                4,
                [4.0, -5.0, 6.0, -1.0],
            ),
        ] {
            let (edges, own) = about(inner);
            assert!(is_near(own, extent), "{inner}: {own:?}");
            assert_eq!(edges, count, "{inner}");
        }
    }

    #[test]
    fn a_dashed_line_is_its_dashes() {
        assert_eq!(about(r#"<path d="M1 1H6" stroke="red" stroke-dasharray="1 1"/>"#).0, 3 * 4);
    }

    #[test]
    fn what_is_no_figure_is_refused() {
        let picture = |inner: &str| lines(&format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{inner}</svg>"));
        for (inner, fault) in [
            ("<text>a</text>", "has a text (line 2)"),
            (
                r#"<filter id="f"><feGaussianBlur stdDeviation="1"/></filter><rect filter="url(#f)" width="1" height="1"/>"#,
                "a filter",
            ),
            ("<rect", "is no SVG picture"),
        ] {
            let error = picture(inner).expect_err(inner);
            assert!(error.contains(fault), "{error}");
        }
    }
}
