//! Draws egui's triangles without a GPU like its OpenGL shader: colours are multiplied and blended in gamma space.

use egui::epaint::{ImageData, ImageDelta, Mesh, Primitive, TextureId, Vertex};
use egui::{Color32, Context, FullOutput, Rect, TexturesDelta};
use egui_kittest::TestRenderer;
use image::RgbaImage;
use std::array::from_fn;
use std::collections::HashMap;
use std::ops::Range;

/// Corners lie on a grid with this many steps per pixel, as on GPUs: triangles that share an edge share it exactly.
const GRID: f32 = 256.0;

/// A software renderer with its textures.
#[derive(Default)]
pub(super) struct Renderer {
    textures: HashMap<TextureId, Texture>,
}

struct Texture {
    size: [usize; 2],
    pixels: Vec<Color32>,
}

impl Texture {
    /// Replaces a whole texture or a part of one.
    fn update(&mut self, delta: &ImageDelta) {
        let ImageData::Color(image) = &delta.image;
        let Some([left, top]) = delta.pos else {
            *self = Self { size: image.size, pixels: image.pixels.clone() };
            return;
        };
        for (row, pixels) in image.pixels.chunks_exact(image.width()).enumerate() {
            let start = (top + row) * self.size[0] + left;
            self.pixels[start..start + pixels.len()].copy_from_slice(pixels);
        }
    }

    fn pixel(&self, x: f32, y: f32) -> Color32 {
        let [width, height] = self.size;
        let (x, y) = ((x.max(0.0) as usize).min(width - 1), (y.max(0.0) as usize).min(height - 1));
        self.pixels[y * width + x]
    }

    /// The colour at a point with coordinates from 0 to 1, interpolated between the four nearest pixels.
    fn sample(&self, [u, v, ..]: [f32; 4]) -> [f32; 4] {
        let (x, y) = (u * self.size[0] as f32 - 0.5, v * self.size[1] as f32 - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let (right, below) = (x - left, y - top);
        let four = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[dx, dy]| self.pixel(left + dx, top + dy));
        let [a, b, c, d] = four.map(|pixel| pixel.to_array().map(f32::from));
        if four == [four[0]; 4] {
            return a;
        }
        from_fn(|i| {
            (a[i] * (1.0 - right) + b[i] * right) * (1.0 - below) + (c[i] * (1.0 - right) + d[i] * right) * below
        })
    }
}

/// The picture being drawn.
struct Canvas {
    size: [i64; 2],
    pixels: Vec<[u8; 4]>,
}

impl Canvas {
    /// Blends a colour with premultiplied alpha over a pixel.
    fn blend(&mut self, x: i64, y: i64, colour: [f32; 4]) {
        let pixel = &mut self.pixels[(y * self.size[0] + x) as usize];
        let keep = 1.0 - colour[3] / 255.0;
        for (channel, over) in pixel.iter_mut().zip(colour) {
            *channel = (over + f32::from(*channel) * keep + 0.5) as u8;
        }
    }

    fn triangle(&mut self, mut corners: [Vertex; 3], scale: f32, clip: Rect, texture: &Texture) {
        let place = |corner: &Vertex| [corner.pos.x, corner.pos.y].map(|side| (side * scale * GRID).round() as i64);
        let doubled_area = |[a, b, c]: [[i64; 2]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if doubled_area(corners.each_ref().map(place)) < 0 {
            corners.swap(0, 1);
        }
        let places = corners.each_ref().map(place);
        let area = doubled_area(places);
        if area == 0 {
            return;
        }
        // The pixels that the triangle can reach, by axis.
        let [columns, rows] = [0, 1].map(|axis| {
            let (least, most) =
                places.iter().fold((i64::MAX, i64::MIN), |(least, most), p| (least.min(p[axis]), most.max(p[axis])));
            let clip = if axis == 0 { clip.x_range() } else { clip.y_range() };
            let first = (least >> 8).max(clip.min.round() as i64).max(0);
            first..((most >> 8) + 1).min(clip.max.round() as i64).min(self.size[axis])
        });
        // Most triangles have one colour, and one place in the texture.
        let [uvs, colours] = [corners.map(|corner| [corner.uv.x, corner.uv.y, 0.0, 0.0]), corners.map(colour_of)];
        let is_even = |values: [[f32; 4]; 3]| values[0] == values[1] && values[1] == values[2];
        let texel = is_even(uvs).then(|| texture.sample(uvs[0]));
        let colour = is_even(colours).then_some(colours[0]);
        let both = texel.zip(colour).map(|(texel, colour)| product(texel, colour));
        let edges = from_fn(|i| Edge::new(places[(i + 1) % 3], places[(i + 2) % 3]));
        for y in rows {
            for x in inside(&edges, columns.clone(), y) {
                let blended = both.unwrap_or_else(|| {
                    let shares = edges.each_ref().map(|edge| edge.weight(x, y) as f32 / area as f32);
                    let texel = texel.unwrap_or_else(|| texture.sample(mixed(uvs, shares)));
                    product(texel, colour.unwrap_or_else(|| mixed(colours, shares)))
                });
                self.blend(x, y, blended);
            }
        }
    }

    fn mesh(&mut self, mesh: &Mesh, scale: f32, clip: Rect, texture: &Texture) {
        for corners in mesh.indices.chunks_exact(3) {
            self.triangle(from_fn(|i| mesh.vertices[corners[i] as usize]), scale, clip, texture);
        }
    }
}

fn colour_of(corner: Vertex) -> [f32; 4] {
    corner.color.to_array().map(f32::from)
}

/// The mean of the values at the corners.
fn mixed(corners: [[f32; 4]; 3], shares: [f32; 3]) -> [f32; 4] {
    from_fn(|i| corners[0][i] * shares[0] + corners[1][i] * shares[1] + corners[2][i] * shares[2])
}

fn product(texel: [f32; 4], colour: [f32; 4]) -> [f32; 4] {
    from_fn(|i| texel[i] * colour[i] / 255.0)
}

/// The edge opposite a corner.
struct Edge {
    from: [i64; 2],
    side: [i64; 2],
    /// The least weight that is inside: a point on an edge belongs only to the triangle to the right of the edge or below it.
    least: i64,
}

impl Edge {
    fn new(from: [i64; 2], to: [i64; 2]) -> Self {
        let side = [to[0] - from[0], to[1] - from[1]];
        let is_top_or_left = side[1] < 0 || (side[1] == 0 && side[0] > 0);
        Self { from, side, least: i64::from(!is_top_or_left) }
    }

    /// The weight of the corner in the middle of a pixel.
    fn weight(&self, x: i64, y: i64) -> i64 {
        self.side[0] * (y * 256 + 128 - self.from[1]) - self.side[1] * (x * 256 + 128 - self.from[0])
    }
}

/// Those columns of a row whose pixels are inside all three edges.
fn inside(edges: &[Edge; 3], columns: Range<i64>, y: i64) -> Range<i64> {
    edges.iter().fold(columns.clone(), |inside, edge| {
        let (spare, growth) = (edge.weight(columns.start, y) - edge.least, -256 * edge.side[1]);
        match growth {
            1.. => inside.start.max(columns.start - spare.div_euclid(growth))..inside.end,
            0 if spare >= 0 => inside,
            0 => 0..0,
            _ => inside.start..inside.end.min(columns.start + spare.div_euclid(-growth) + 1),
        }
    })
}

impl TestRenderer for Renderer {
    fn handle_delta(&mut self, delta: &mut TexturesDelta) {
        for (id, images) in delta.set.drain() {
            let texture = self.textures.entry(id).or_insert(Texture { size: [0; 2], pixels: Vec::new() });
            images.iter().for_each(|image| texture.update(image));
        }
        for id in delta.free.drain() {
            self.textures.remove(&id);
        }
    }

    fn render(&mut self, context: &Context, output: &FullOutput) -> Result<RgbaImage, String> {
        let scale = context.pixels_per_point();
        let size = context.content_rect().size() * scale;
        let size = [size.x.round() as i64, size.y.round() as i64];
        let mut canvas = Canvas { size, pixels: vec![[0, 0, 0, 255]; (size[0] * size[1]) as usize] };
        for job in context.tessellate(output.shapes.clone(), scale) {
            let Primitive::Mesh(mesh) = &job.primitive else { continue };
            let texture = self.textures.get(&mesh.texture_id).ok_or("a texture is missing")?;
            canvas.mesh(mesh, scale, job.clip_rect * scale, texture);
        }
        RgbaImage::from_raw(size[0] as u32, size[1] as u32, canvas.pixels.into_flattened())
            .ok_or_else(|| "the picture has another size".to_owned())
    }
}
