//! The parameters of a scenario, as a person changes them.

use crate::scenario::Scenario;
use bevy_egui::egui;

pub struct Change { pub label: String, pub held: bool }
#[derive(Default)]
pub struct PanelState {}
#[derive(Debug, Clone, PartialEq)]
pub enum PanelAsk { OpenWif, OpenImage { path: String } }
impl PanelState { pub fn take_ask(&mut self) -> Option<PanelAsk> { None } }
pub fn parameters(ui: &mut egui::Ui, _: &mut Scenario, _: &mut PanelState) -> Option<Change> { ui.label("parameters"); None }
pub fn weave(_: &mut egui::Ui, _: &mut Scenario, _: &mut PanelState) -> Option<Change> { None }
pub fn answer(_: &mut Scenario, _: &PanelAsk, _: &str) -> Change { Change { label: String::new(), held: false } }
