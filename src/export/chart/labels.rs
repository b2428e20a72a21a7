//! Where do labels stand, so that none hides a point or another label?

/// Width of a character of the labels' font, as a share of its size: the mean of a bold sans-serif face.
const CHARACTER: f64 = 0.66;

/// A rectangle on the sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

impl Patch {
    /// The square of that half side around a place.
    pub fn around([x, y]: [f64; 2], half: f64) -> Self {
        Self { left: x - half, top: y - half, right: x + half, bottom: y + half }
    }

    /// The rectangle between two corners.
    pub fn between([left, top]: [f64; 2], [right, bottom]: [f64; 2]) -> Self {
        Self { left, top, right, bottom }
    }

    fn meets(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    fn holds(&self, other: &Self) -> bool {
        self.left <= other.left && other.right <= self.right && self.top <= other.top && other.bottom <= self.bottom
    }
}

/// Places labels one by one, the most important first.
#[derive(Debug)]
pub struct Labels {
    sheet: Patch,
    taken: Vec<Patch>,
}

impl Labels {
    /// No labels yet, on a sheet where these patches are taken.
    pub fn new(sheet: Patch, taken: Vec<Patch>) -> Self {
        Self { sheet, taken }
    }

    /// Where a text of that font size begins (left end of its base line) to stand by a point, `away` from its middle;
    /// `None` where there is no room for it.
    pub fn place(&mut self, text: &str, size: f64, [x, y]: [f64; 2], away: f64) -> Option<[f64; 2]> {
        let width = text.chars().count() as f64 * size * CHARACTER;
        let middle = x - width / 2.0;
        let aside = 0.75 * away;
        let tries = [
            [middle, y + away + size],
            [x + away, y + size * 0.35],
            [x - away - width, y + size * 0.35],
            [middle, y - away - size * 0.3],
            [x + aside, y + aside + size],
            [x - aside - width, y + aside + size],
            [x + aside, y - aside - size * 0.3],
            [x - aside - width, y - aside - size * 0.3],
        ];
        let patch = |[left, base]: [f64; 2]| Patch {
            left,
            top: base - 0.8 * size,
            right: left + width,
            bottom: base + 0.2 * size,
        };
        let is_free = |at: &[f64; 2]| {
            let patch = patch(*at);
            self.sheet.holds(&patch) && !self.taken.iter().any(|taken| taken.meets(&patch))
        };
        let found = tries.into_iter().find(is_free)?;
        self.taken.push(patch(found));
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_keep_off_each_other_and_end_when_there_is_no_room() {
        let sheet = Patch::between([0.0, 0.0], [100.0, 60.0]);
        let mut labels = Labels::new(sheet, Vec::new());
        let placed: Vec<_> = (0..20).map_while(|_| labels.place("label", 10.0, [50.0, 30.0], 5.0)).collect();
        assert!((2..=8).contains(&placed.len()), "{placed:?}");
        for (number, a) in labels.taken.iter().enumerate() {
            assert!(sheet.holds(a) && labels.taken[..number].iter().all(|b| !a.meets(b)));
        }
    }
}
