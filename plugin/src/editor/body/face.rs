//! Paints a body.

use crate::editor::theme::{Palette, SMALL};
use crate::editor::widgets::text::{line, width};
use egui::cache::{ComputerMut, FrameCache};
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, Vec2, vec2};
use sprung_picture::{Figure, Ink, Picture, Pose};
use std::hash::{Hash, Hasher};

/// Space around a body, for its handles and for the frame that says that it is only a guess.
const AROUND: f32 = 14.0;

/// What a body at rest takes of a picture, and the room in which its handles are taken hold of.
pub(super) fn bounds(rect: Rect, figure: &Figure) -> Rect {
    figure.frame(rect).expand(AROUND).intersect(rect)
}

/// Paints a dashed frame around a body that is drawn for a table of modes, which knows of none.
pub(super) fn paint_guess(painter: &Painter, frame: Rect, palette: &Palette) {
    let corners = [frame.left_top(), frame.right_top(), frame.right_bottom(), frame.left_bottom(), frame.left_top()];
    painter.extend(Shape::dashed_line(&corners, Stroke::new(1.0, palette.muted), 6.0, 5.0));
}

/// Paints the body. Returns where it is struck, if that is known.
pub(crate) fn paint(painter: &Painter, rect: Rect, figure: &Figure, pose: &Pose, palette: &Palette) -> Option<Pos2> {
    let picture = Picture::of(rect, figure, pose, palette.accent);
    let struck = picture.strike;
    painter.extend(shapes(picture, palette));
    struck
}

/// How a handle is painted: its size as a multiple of the smallest, whether its name stands beside it, and whether it has the focus.
#[derive(Clone, Copy)]
pub(crate) struct Look {
    pub(super) size: f32,
    pub(super) is_named: bool,
    pub(super) is_focused: bool,
}

impl Look {
    /// A handle that only shows where its place is.
    pub(crate) const SMALL: Self = Self { size: 1.0, is_named: false, is_focused: false };
}

/// Paints the ring around the place that is struck.
pub(crate) fn paint_ring(painter: &Painter, at: Pos2, look: Look, palette: &Palette) {
    paint_handle(painter, at, look, palette.accent, palette);
    if look.is_named {
        name(painter, at + vec2(5.5 * look.size, 0.0), "strike", palette);
    }
}

/// Paints the ear at the place that is heard: a ring with waves.
pub(super) fn paint_ear(painter: &Painter, at: Pos2, look: Look, palette: &Palette) {
    paint_handle(painter, at, look, palette.text, palette);
    for radius in [9.5, 13.5].map(|radius| radius * look.size) {
        let arc = (-3..=3).map(|step| at + radius * Vec2::angled(step as f32 * 0.25));
        painter.add(Shape::line(arc.collect(), Stroke::new(1.5, palette.text)));
    }
    if look.is_focused {
        painter.circle_stroke(at, 17.0 * look.size, Stroke::new(1.5, palette.text));
    }
    if look.is_named {
        name(painter, at + vec2(13.5 * look.size, 0.0), "listen", palette);
    }
}

fn paint_handle(painter: &Painter, at: Pos2, look: Look, edge: Color32, palette: &Palette) {
    painter.circle(at, 5.5 * look.size, palette.panel, Stroke::new(2.0, edge));
    painter.circle_filled(at, 1.8 * look.size, palette.text);
}

/// Writes the name of a handle beside it, on a ground of its own.
fn name(painter: &Painter, at: Pos2, name: &str, palette: &Palette) {
    let size = vec2(width(painter, name, SMALL) + 8.0, 15.0);
    let place = Rect::from_min_size(at + vec2(5.0, -0.5 * size.y), size);
    painter.rect_filled(place, 4.0, palette.panel);
    line(painter, place, Align2::CENTER_CENTER, name, SMALL, palette.text);
}

/// Paints a body at rest.
pub(crate) fn paint_still(painter: &Painter, rect: Rect, figure: &Figure, palette: &Palette) {
    Still { rect, figure, palette, stands: false }.paint(painter);
}

/// Paints a body that stands on the lower edge of the rectangle.
pub(crate) fn paint_standing(painter: &Painter, rect: Rect, figure: &Figure, palette: &Palette) {
    Still { rect, figure, palette, stands: true }.paint(painter);
}

/// A body at rest.
#[derive(Clone, Copy)]
struct Still<'a> {
    rect: Rect,
    figure: &'a Figure,
    palette: &'a Palette,
    /// Whether it stands on the lower edge of the rectangle.
    stands: bool,
}

impl Still<'_> {
    /// Its shapes are made once for as long as it is seen.
    fn paint(self, painter: &Painter) {
        let shapes = painter.ctx().memory_mut(|memory| memory.caches.cache::<Seen>().get(self).clone());
        painter.extend(shapes);
    }
}

/// By what is seen of it.
impl Hash for Still<'_> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        let corners = [self.rect.min, self.rect.max].map(|corner| [corner.x.to_bits(), corner.y.to_bits()]);
        let Palette { accent, line, muted, text, .. } = self.palette;
        (corners, self.figure, [accent, line, muted, text], self.stands).hash(state);
    }
}

/// The shapes of the bodies at rest that were seen in the last frame.
type Seen = FrameCache<Vec<Shape>, ShapesOfStill>;

#[derive(Default)]
struct ShapesOfStill;

impl ComputerMut<Still<'_>, Vec<Shape>> for ShapesOfStill {
    fn compute(&mut self, Still { rect, figure, palette, stands }: Still) -> Vec<Shape> {
        let picture = Picture::of(rect, figure, &Pose::default(), palette.accent);
        shapes(if stands { picture.standing(rect.bottom()) } else { picture }, palette)
    }
}

fn shapes(picture: Picture, palette: &Palette) -> Vec<Shape> {
    let mut shapes = Vec::new();
    if let [first, .., last] = picture.string[..] {
        shapes.push(Shape::line_segment([first, last], Stroke::new(1.0, palette.line)));
        shapes.extend([first, last].map(|end| Shape::circle_filled(end, 3.0, palette.muted)));
        shapes.push(Shape::line(picture.string, Stroke::new(2.5, palette.accent)));
    }
    let edge = |(ends, colour)| Shape::line_segment(ends, Stroke::new(1.0, colour));
    shapes.extend(picture.outline.into_iter().map(edge));
    let vertices = picture.vertices.into_iter().map(|(pos, color)| Vertex { pos, uv: WHITE_UV, color }).collect();
    shapes.push(Shape::mesh(Mesh { vertices, indices: picture.triangles.concat(), ..Mesh::default() }));
    shapes.extend(picture.lines.into_iter().map(|(ink, points)| {
        let stroke = match ink {
            Ink::Edge => Stroke::new(1.2, palette.text.gamma_multiply(0.5)),
            Ink::Fine => Stroke::new(1.0, palette.text.gamma_multiply(0.25)),
            Ink::Node => Stroke::new(1.0, palette.text.gamma_multiply(0.6)),
            Ink::Joint => Stroke::new(1.3, palette.muted),
        };
        Shape::line(points, stroke)
    }));
    shapes
}
