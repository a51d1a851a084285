//! The draft of a scenario's cloth.

use super::{Draft, DraftError, MOST_THREADS, Thread};
use crate::scenario::{Scenario, YarnSpec};
use crate::texture::{Hsv, to_rgb};

impl Draft {
    /// Drafts the cloth of a scenario, end by end and pick by pick; at least one repeat of its weave,
    /// at most [`MOST_THREADS`] threads each way.
    ///
    /// Its yarns are undyed, so that a true picture of the draft would show nothing. As in a drawdown
    /// on paper, the warp is dark and the weft light.
    ///
    /// # Errors
    /// [`DraftError::Size`] for a weave that no draft has room for; a checked scenario has none.
    pub fn of_scenario(scenario: &Scenario) -> Result<Draft, DraftError> {
        let cloth = &scenario.cloth;
        let weave = cloth.weave.matrix();
        let (across, down) = cloth.cells();
        let [light, _, dark] = scenario.look.colours.stops();
        let lay = |yarn: &YarnSpec, cells: usize, repeat: usize, colour: Hsv| {
            let width = yarn.width.whole_cells(cloth.cell_mm).max(1);
            let pitch = width + yarn.gap.whole_cells(cloth.cell_mm);
            let thread = Thread {
                colour: Some(to_rgb(colour).map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)),
                spacing_mm: Some(pitch as f64 * cloth.cell_mm),
                thickness_mm: Some(width as f64 * cloth.cell_mm),
            };
            vec![
                thread;
                cells
                    .div_ceil(pitch)
                    .clamp(repeat.min(MOST_THREADS), MOST_THREADS)
            ]
        };
        let warp = lay(&cloth.warp, across, weave.ends(), dark);
        let weft = lay(cloth.weft(), down, weave.picks(), light);
        let draft = Draft::of_weave(&weave, warp, weft)?;
        Ok(draft
            .with_title(&scenario.title)
            .with_notes(["Both yarns are undyed; the warp is drawn dark so that the weave shows."]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::repeat;
    use crate::scenario::{Experiment, bundled};

    #[test]
    fn the_draft_of_every_bundled_scenario_has_its_weave_and_its_yarns() {
        for scenario in bundled() {
            let scenario = Experiment::load(scenario.name).unwrap().scenario;
            let draft = Draft::of_scenario(&scenario).unwrap();
            let (drawn, weave) = (draft.drawdown(), scenario.cloth.weave.matrix());
            let whole = drawn.ends() % weave.ends() == 0 && drawn.picks() % weave.picks() == 0;
            assert!(!whole || repeat(&drawn) == repeat(&weave));
            for (e, p) in [(0, 0), (1, 0), (0, 1), (5, 3), (3, 5)] {
                assert_eq!(drawn.warp_up(e, p), weave.warp_up(e, p));
            }
            let width: f64 = draft.warp().iter().filter_map(|end| end.spacing_mm).sum();
            let cloth = scenario.cloth.cells().0 as f64 * scenario.cloth.cell_mm;
            let pitch = draft.warp()[0].spacing_mm.unwrap();
            assert!(
                width >= cloth - 1e-6 && width < cloth + pitch,
                "{width} {cloth}"
            );
        }
    }
}
