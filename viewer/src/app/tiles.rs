//! The panes and how they stand at first: layers and changes at the left, the view over the tables, what is picked at the right.

use crate::panels::{self, Pane};
use crate::state::State;
use crate::view::View;
use egui::{Ui, WidgetText};
use egui_tiles::{Behavior, Linear, LinearDir, SimplificationOptions, TileId, Tiles, Tree, UiResponse};

/// Shows panes.
pub struct Panes<'a> {
    /// All that they show.
    pub state: &'a mut State,
    /// The pane with the picture.
    pub view: &'a mut View,
}

impl Behavior<Pane> for Panes<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _tile: TileId, pane: &mut Pane) -> UiResponse {
        let state = &mut *self.state;
        if *pane == Pane::View {
            self.view.show(ui, state);
            return UiResponse::None;
        }
        egui::Frame::new().inner_margin(egui::Margin::symmetric(8, 4)).show(ui, |ui| match pane {
            Pane::View => {}
            Pane::Layers => panels::layers::show(ui, state),
            Pane::Scene => panels::scene::show(ui, state),
            Pane::Inspector => panels::inspector::show(ui, state),
            Pane::Sensors => panels::sensors::show(ui, state),
            Pane::Chart => panels::chart::show(ui, state),
            Pane::Stages => panels::stages::show(ui, state),
            Pane::Log => panels::log::show(ui, state),
            Pane::Outdoors => panels::outdoors::show(ui, state),
            Pane::Map => panels::map::show(ui, state),
        });
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        pane.title().into()
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }
}

/// The panes as they stand at first.
pub fn first() -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let mut tabs = |panes: &[Pane]| {
        let panes: Vec<TileId> = panes.iter().map(|&pane| tiles.insert_pane(pane)).collect();
        let first = panes.first().copied();
        let tabs = tiles.insert_tab_tile(panes);
        if let (Some(egui_tiles::Tile::Container(egui_tiles::Container::Tabs(tabs))), Some(first)) =
            (tiles.get_mut(tabs), first)
        {
            tabs.set_active(first);
        }
        tabs
    };
    let left = tabs(&[Pane::Layers, Pane::Scene, Pane::Outdoors]);
    let view = tabs(&[Pane::View]);
    let below = tabs(&[Pane::Sensors, Pane::Chart, Pane::Stages, Pane::Map, Pane::Log]);
    let right = tabs(&[Pane::Inspector]);
    let middle = shared(&mut tiles, LinearDir::Vertical, &[(view, 0.74), (below, 0.26)]);
    let root = shared(&mut tiles, LinearDir::Horizontal, &[(left, 0.22), (middle, 0.56), (right, 0.22)]);
    Tree::new(egui::Id::unique("panes"), root, tiles)
}

fn shared(tiles: &mut Tiles<Pane>, direction: LinearDir, shares: &[(TileId, f32)]) -> TileId {
    let mut linear = Linear::new(direction, shares.iter().map(|(tile, _)| *tile).collect());
    for (tile, share) in shares {
        linear.shares.set_share(*tile, *share);
    }
    tiles.insert_container(linear)
}

/// Whether every pane is there once: what was kept may be of another version.
pub fn is_whole(tree: &Tree<Pane>) -> bool {
    Pane::ALL.iter().all(|&pane| tree.tiles.find_pane(&pane).is_some())
}

/// Brings a pane to the front.
pub fn bring(tree: &mut Tree<Pane>, pane: Pane) {
    if let Some(tile) = tree.tiles.find_pane(&pane) {
        tree.make_active(|id, _| id == tile);
    }
}
