//! What stands how high, seen from straight above?
//!
//! An orthographic depth map from the zenith: over each texel of a level grid the highest surface at its middle, and, for
//! scenes that are no height field, all surfaces under it (depth peeling), joined to [`Span`]s of matter: a face that looks up
//! begins one, a face that looks down ends it, nested solids count. Triangles are drawn by their edges, each texel's middle
//! once.
//!
//! Limits: glazing is left out and passes all; an upward sheet with nothing below it that looks down is taken for solid down to
//! whatever does; what is narrower than a texel may fall between two.

use crate::job::{Cancel, Cancelled};
use crate::scene::{Material, Scene};
use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

/// Height of what is not there.
pub const NOTHING_M: f32 = f32::NEG_INFINITY;

/// Texels along the longer side where no size is asked for: 20 cm in a street of 200 m.
pub const TEXELS: usize = 1024;

/// Most texels along a side: 64 million texels.
pub const MOST_TEXELS: usize = 8192;

/// Surfaces of one texel nearer to each other than this share of the scene's height are one: the same face drawn by two
/// triangles.
const SAME_SHARE: f32 = 1e-5;

/// A level this small, of either side, has none above it: it stays near the processor anyway.
const LEAST_TEXELS: usize = 64;

/// Rows of a block that is drawn by one thread; every block looks at every triangle.
const ROWS_A_BLOCK: usize = 128;

/// Matter over a texel, from below to above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Its underside, metres; [`NOTHING_M`] where it reaches down without end.
    pub bottom_m: f32,
    /// Its upper side, metres.
    pub top_m: f32,
}

/// The map.
#[derive(Debug, Clone)]
pub struct Zenith {
    /// The corner of texel (0, 0) towards -x and -y, metres.
    pub corner_m: Vec2,
    /// Edge of a texel, metres.
    pub texel_m: f32,
    /// The highest surface of all, metres.
    pub highest_m: f32,
    /// The map, then every second texel of it each way, and so on: what is read far away is read from few places of memory.
    pub levels: Vec<Level>,
}

/// The texels of one level.
#[derive(Debug, Clone, Default)]
pub struct Level {
    /// Texels along x and y.
    pub size: [usize; 2],
    /// The highest surface of each texel, row by row (x fastest), metres; [`NOTHING_M`] where there is none.
    pub top_m: Vec<f32>,
    /// What stands and floats over each texel, and one more; empty where only the highest surfaces were asked for.
    columns: Vec<Column>,
    /// Spans, those of a texel in a row, from above to below.
    spans: Vec<Span>,
}

/// What stands over a texel.
#[derive(Debug, Clone, Copy, Default)]
struct Column {
    /// The top of what reaches down without end, metres; [`NOTHING_M`] where nothing does.
    ground_m: f32,
    /// Where its floating spans begin; they end where those of the next texel begin.
    first: u32,
}

/// A surface over a texel.
#[derive(Debug, Clone, Copy)]
struct Surface {
    texel: u32,
    height_m: f32,
    looks_up: bool,
}

impl Zenith {
    /// The map of a scene with `texels` along the longer side, 8 to [`MOST_TEXELS`]; `peeled` for all surfaces. A scene
    /// without triangles has one empty texel.
    ///
    /// Time grows with the triangles and the texels they cover: some 10 ms for 74,000 triangles on 1024 x 1024, five times
    /// that peeled. The same bits for any number of threads.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(scene: &Scene, texels: usize, peeled: bool, cancel: &Cancel) -> Result<Self, Cancelled> {
        let mesh = &scene.mesh;
        let (low_m, high_m) = mesh.bounds_m().unwrap_or((Vec3::ZERO, Vec3::ZERO));
        let extent_m = (high_m - low_m).truncate();
        let texels = texels.clamp(8, MOST_TEXELS);
        let texel_m = (extent_m.max_element() / texels as f32).max(f32::MIN_POSITIVE.sqrt());
        let size = [extent_m.x, extent_m.y].map(|side_m| ((side_m / texel_m).ceil() as usize).clamp(1, texels));
        let mut map = Self { corner_m: low_m.truncate(), texel_m, highest_m: high_m.z, levels: Vec::new() };

        let is_opaque =
            |triangle: usize| scene.material(triangle).is_none_or(|material| Material::passes(material) <= 0.0);
        let triangles: Vec<[DVec3; 3]> = (0..mesh.triangles.len())
            .filter(|&triangle| is_opaque(triangle))
            .filter_map(|triangle| Some(map.in_texels(mesh.corners_m(triangle)?)))
            .collect();
        let same_m = SAME_SHARE * (high_m.z - low_m.z).max(texel_m);
        let blocks: Result<Vec<Block>, Cancelled> = (0..size[1].div_ceil(ROWS_A_BLOCK))
            .into_par_iter()
            .map(|block| {
                cancel.check()?;
                let rows = block * ROWS_A_BLOCK..((block + 1) * ROWS_A_BLOCK).min(size[1]);
                Ok(Block::drawn(&triangles, size[0], rows, peeled, same_m))
            })
            .collect();
        let mut level = Level { size, ..Level::default() };
        for block in blocks? {
            let before = level.spans.len() as u32;
            level.top_m.extend(block.top_m);
            level.columns.extend(block.columns.iter().map(|column| Column { first: before + column.first, ..*column }));
            level.spans.extend(block.spans);
        }
        if peeled {
            level.columns.push(Column { ground_m: NOTHING_M, first: level.spans.len() as u32 });
        }
        while level.size.iter().any(|side| *side > LEAST_TEXELS) {
            let next = level.thinned();
            map.levels.push(std::mem::replace(&mut level, next));
        }
        map.levels.push(level);
        Ok(map)
    }

    /// Texel coordinates of a triangle's corners, heights in metres.
    fn in_texels(&self, corners_m: [Vec3; 3]) -> [DVec3; 3] {
        corners_m.map(|corner_m| {
            let at = (corner_m.truncate() - self.corner_m).as_dvec2() / f64::from(self.texel_m);
            at.extend(f64::from(corner_m.z))
        })
    }

    /// Where a place lies on the map, in texels from its corner.
    pub fn at(&self, place_m: Vec2) -> Vec2 {
        (place_m - self.corner_m) / self.texel_m
    }

    /// From one corner of the map to the other, metres.
    pub fn farthest_m(&self) -> f32 {
        self.levels.first().map_or(0.0, |level| self.texel_m * Vec2::from(level.size.map(|side| side as f32)).length())
    }

    /// The level whose texels are at most that wide, the finest if all are wider.
    pub fn level_of(&self, width_m: f32) -> usize {
        let doublings = (width_m / self.texel_m).log2().floor();
        (doublings.max(0.0) as usize).min(self.levels.len() - 1)
    }

    /// How many texels have something that floats.
    pub fn floating(&self) -> usize {
        let columns = self.levels.first().map_or(&[][..], |level| &level.columns);
        columns.windows(2).filter(|pair| pair[0].first < pair[1].first).count()
    }
}

impl Level {
    /// The number of a texel; `None` beyond the map.
    #[inline]
    pub fn texel(&self, column: i32, row: i32) -> Option<usize> {
        // A negative number is large without its sign.
        let [column, row] = [column, row].map(|at| at.cast_unsigned() as usize);
        (column < self.size[0] && row < self.size[1]).then(|| row * self.size[0] + column)
    }

    /// The top of what stands on the ground of a texel of a peeled map, metres, and the spans that float over it, from above to
    /// below.
    #[inline]
    pub fn column(&self, texel: usize) -> (f32, &[Span]) {
        match self.columns.get(texel..texel + 2) {
            Some([this, next]) if this.first == next.first => (this.ground_m, &[]),
            Some([this, next]) => {
                (this.ground_m, self.spans.get(this.first as usize..next.first as usize).unwrap_or_default())
            }
            _ => (NOTHING_M, &[]),
        }
    }

    /// Every second texel each way, of each four the one nearest to their middle that lies above and right of it.
    fn thinned(&self) -> Self {
        let size = self.size.map(|side| side.div_ceil(2));
        let mut thin = Self { size, ..Self::default() };
        for row in 0..size[1] {
            for column in 0..size[0] {
                let [x, y] = [(2 * column + 1).min(self.size[0] - 1), (2 * row + 1).min(self.size[1] - 1)];
                let texel = y * self.size[0] + x;
                thin.top_m.push(self.top_m.get(texel).copied().unwrap_or(NOTHING_M));
                if !self.columns.is_empty() {
                    let (ground_m, spans) = self.column(texel);
                    thin.columns.push(Column { ground_m, first: thin.spans.len() as u32 });
                    thin.spans.extend_from_slice(spans);
                }
            }
        }
        if !self.columns.is_empty() {
            thin.columns.push(Column { ground_m: NOTHING_M, first: thin.spans.len() as u32 });
        }
        thin
    }
}

/// Some rows of the map.
#[derive(Default)]
struct Block {
    top_m: Vec<f32>,
    columns: Vec<Column>,
    spans: Vec<Span>,
}

impl Block {
    fn drawn(
        triangles: &[[DVec3; 3]],
        columns: usize,
        rows: std::ops::Range<usize>,
        peeled: bool,
        same_m: f32,
    ) -> Self {
        let first = rows.start * columns;
        let mut block = Self { top_m: vec![NOTHING_M; columns * rows.len()], ..Self::default() };
        let mut surfaces = Vec::new();
        for corners in triangles {
            draw(corners, columns, &rows, |texel, height_m, looks_up| {
                if let Some(top_m) = block.top_m.get_mut(texel - first) {
                    *top_m = top_m.max(height_m);
                }
                if peeled {
                    surfaces.push(Surface { texel: (texel - first) as u32, height_m, looks_up });
                }
            });
        }
        if peeled {
            // From above; where a face that looks down lies on one that looks up, as two bodies touch, the matter goes on.
            surfaces.sort_unstable_by(|a, b| {
                let height = b.height_m.total_cmp(&a.height_m);
                a.texel.cmp(&b.texel).then(height).then(b.looks_up.cmp(&a.looks_up))
            });
            block.join(&surfaces, same_m);
        }
        block
    }

    /// Joins the surfaces of each texel, sorted from above, to spans.
    fn join(&mut self, surfaces: &[Surface], same_m: f32) {
        let mut of_texel = surfaces.chunk_by(|a, b| a.texel == b.texel).peekable();
        for texel in 0..self.top_m.len() {
            let first = self.spans.len() as u32;
            let mut ground_m = NOTHING_M;
            if let Some(some) = of_texel.next_if(|some| some.first().is_some_and(|s| s.texel as usize == texel)) {
                let joined = joined(some, same_m);
                ground_m = joined.last().filter(|last| last.bottom_m == NOTHING_M).map_or(NOTHING_M, |last| last.top_m);
                self.spans.extend(joined.into_iter().filter(|span| span.bottom_m != NOTHING_M));
            }
            self.columns.push(Column { ground_m, first });
        }
    }
}

/// The spans of one texel's surfaces, sorted from above.
fn joined(surfaces: &[Surface], same_m: f32) -> Vec<Span> {
    let (mut spans, mut top_m, mut inside) = (Vec::new(), NOTHING_M, 0_u32);
    let mut before: Option<Surface> = None;
    for &surface in surfaces {
        let is_same =
            |other: Surface| other.looks_up == surface.looks_up && other.height_m - surface.height_m <= same_m;
        if before.is_some_and(is_same) {
            continue;
        }
        before = Some(surface);
        match (surface.looks_up, inside) {
            (true, 0) => (top_m, inside) = (surface.height_m, 1),
            (true, _) => inside += 1,
            // A sheet that is seen from below and has no upper side.
            (false, 0) => spans.push(Span { bottom_m: surface.height_m, top_m: surface.height_m }),
            (false, 1) => {
                spans.push(Span { bottom_m: surface.height_m, top_m });
                inside = 0;
            }
            (false, _) => inside -= 1,
        }
    }
    if inside > 0 {
        spans.push(Span { bottom_m: NOTHING_M, top_m });
    }
    spans
}

/// Calls `at` with each texel of these rows whose middle lies under a triangle, its height there and whether it looks up.
fn draw(corners: &[DVec3; 3], columns: usize, rows: &std::ops::Range<usize>, mut at: impl FnMut(usize, f32, bool)) {
    let [a, b, c] = *corners;
    let twice_area = (b - a).truncate().perp_dot((c - a).truncate());
    // Seen from the side it covers nothing.
    if twice_area == 0.0 || !twice_area.is_finite() {
        return;
    }
    let low = a.min(b).min(c);
    let high = a.max(b).max(c);
    let from = |low: f64, least: usize| ((low - 0.5).ceil().max(least as f64)) as usize;
    let to = |high: f64, most: usize| (((high - 0.5).floor() + 1.0).max(0.0) as usize).min(most);
    for row in from(low.y, rows.start)..to(high.y, rows.end) {
        for column in from(low.x, 0)..to(high.x, columns) {
            let middle = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
            let part = |p: DVec3, q: DVec3| (q - p).truncate().perp_dot(middle - p.truncate()) / twice_area;
            let (of_c, of_a, of_b) = (part(a, b), part(b, c), part(c, a));
            if of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0 {
                let height_m = of_a * a.z + of_b * b.z + of_c * c.z;
                at(row * columns + column, height_m as f32, twice_area > 0.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Mesh;

    fn push(mesh: &mut Mesh, corners_m: [[f32; 3]; 3]) {
        let first = mesh.positions_m.len() as u32;
        mesh.positions_m.extend(corners_m.map(Vec3::from_array));
        mesh.triangles.push([first, first + 1, first + 2]);
        mesh.material_of.push(0);
    }

    /// A level rectangle that looks up or down.
    fn level(mesh: &mut Mesh, [x0, y0, x1, y1]: [f32; 4], z: f32, up: bool) {
        let [a, b, c, d] = [[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]];
        let turned = |[p, q, r]: [[f32; 3]; 3]| if up { [p, q, r] } else { [p, r, q] };
        push(mesh, turned([a, b, c]));
        push(mesh, turned([a, c, d]));
    }

    fn map(mesh: Mesh, texels: usize) -> Zenith {
        let scene = Scene { mesh, ..Scene::default() };
        Zenith::new(&scene, texels, true, &Cancel::new()).unwrap()
    }

    #[test]
    fn a_bridge_over_ground_is_a_span_over_it() {
        let mut mesh = Mesh::default();
        level(&mut mesh, [0.0, 0.0, 16.0, 8.0], 0.0, true);
        level(&mut mesh, [4.0, 0.0, 8.0, 8.0], 3.0, true);
        level(&mut mesh, [4.0, 0.0, 8.0, 8.0], 2.5, false);
        // A body on the ground with the ground going on under it.
        level(&mut mesh, [12.0, 0.0, 16.0, 8.0], 5.0, true);
        level(&mut mesh, [12.0, 0.0, 16.0, 8.0], 0.0, false);
        let map = map(mesh, 16);
        let level = &map.levels[0];
        assert_eq!((level.size, map.texel_m), ([16, 8], 1.0));
        let bridge = [Span { bottom_m: 2.5, top_m: 3.0 }];
        for row in 0..8 {
            for column in 0..16 {
                let texel = level.texel(column, row).unwrap();
                let (spans, ground_m, top_m) = match column {
                    4..8 => (&bridge[..], 0.0, 3.0),
                    12.. => (&[][..], 5.0, 5.0),
                    _ => (&[][..], 0.0, 0.0),
                };
                assert_eq!((level.column(texel), level.top_m[texel]), ((ground_m, spans), top_m));
            }
        }
        assert_eq!([level.texel(16, 0), level.texel(0, -1)], [None, None]);
    }

    #[test]
    fn nested_and_doubled_faces_are_one_body() {
        let all = [0.0, 0.0, 8.0, 8.0];
        let mut mesh = Mesh::default();
        for (z, up) in [(9.0, true), (9.0, true), (7.0, true), (6.0, false), (4.0, false), (4.0, false), (1.0, false)] {
            level(&mut mesh, all, z, up);
        }
        let map = map(mesh, 8);
        let spans = [Span { bottom_m: 4.0, top_m: 9.0 }, Span { bottom_m: 1.0, top_m: 1.0 }];
        assert!((0..64).all(|texel| map.levels[0].column(texel) == (NOTHING_M, &spans[..])));
        assert_eq!(map.floating(), 64);
    }

    #[test]
    fn a_slanted_roof_has_its_plane_s_heights_and_walls_have_none() {
        let mut mesh = Mesh::default();
        push(&mut mesh, [[0.0, 0.0, 0.0], [10.0, 0.0, 5.0], [10.0, 10.0, 5.0]]);
        push(&mut mesh, [[0.0, 0.0, 0.0], [10.0, 10.0, 5.0], [0.0, 10.0, 0.0]]);
        push(&mut mesh, [[3.5, 0.0, 0.0], [3.5, 10.0, 0.0], [3.5, 10.0, 50.0]]);
        let map = map(mesh, 10);
        for texel in 0..100 {
            let expected_m = 0.5 * ((texel % 10) as f32 + 0.5);
            assert!((map.levels[0].top_m[texel] - expected_m).abs() < 1e-5);
            assert!(map.levels[0].column(texel).1.is_empty());
        }
    }

    #[test]
    fn an_empty_scene_has_an_empty_texel() {
        let map = map(Mesh::default(), 100);
        assert_eq!((map.levels[0].size, &map.levels[0].top_m[..]), ([1, 1], &[NOTHING_M][..]));
    }

    #[test]
    fn a_thinner_level_has_texels_of_the_finer_one() {
        let mut mesh = Mesh::default();
        level(&mut mesh, [0.0, 0.0, 201.0, 130.0], 0.0, true);
        level(&mut mesh, [50.0, 0.0, 90.0, 130.0], 3.0, true);
        level(&mut mesh, [50.0, 0.0, 90.0, 130.0], 2.0, false);
        let map = map(mesh, 201);
        assert_eq!(map.levels.iter().map(|level| level.size).collect::<Vec<_>>(), [[201, 130], [101, 65], [51, 33]]);
        for (number, level) in map.levels.iter().enumerate() {
            for texel in 0..level.top_m.len() {
                let x = ((texel % level.size[0]) << number) + ((1 << number) - 1);
                let floats = (50..90).contains(&x.min(200));
                assert_eq!(
                    (level.column(texel).1.len(), level.top_m[texel]),
                    (usize::from(floats), if floats { 3.0 } else { 0.0 })
                );
            }
        }
        assert_eq!([0.4, 1.0, 1.9, 2.0, 5.0, 1e9].map(|width_m| map.level_of(width_m)), [0, 0, 0, 1, 2, 2]);
    }
}
