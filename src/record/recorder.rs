//! The recorder: keeps the frames that it is told to expect.

use std::collections::BTreeSet;
use std::io::{self, Write};

use bevy::prelude::*;

use super::RecordError;
use super::fields::{self, State};
use super::folder::{Folder, below, frame_name, state_name};
use super::manifest::{self, Frame, MANIFEST, Manifest};
use super::plan::Stop;
use super::sheet::{Sheet, moment};
use super::writer::{self, Job, Writer};
use crate::adsorption::BoundDye;
use crate::cloth::Cloth;
use crate::diffusion::FreeDye;
use crate::ledger::Ledger;
use crate::scenario::units::rounded;
use crate::scenario::{Beside, Experiment, Origin};
use crate::schedule::{DyeFrame, FrameSet, ProcessClock, TheExperiment};
use crate::supply::Supplies;
use crate::texture::Picture;

/// Recording of every frame that the [`Recorder`] is told to expect.
pub struct RecordPlugin;

impl Plugin for RecordPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            DyeFrame,
            keep.in_set(FrameSet::Keep)
                .run_if(resource_exists::<Recorder>),
        );
    }
}

/// Keeps frames in a folder.
#[derive(Resource)]
pub struct Recorder {
    folder: Folder,
    writer: Writer,
    manifest: Manifest,
    ledger: String,
    sheet: Sheet,
    expected: Option<Stop>,
    failed: Option<RecordError>,
}

impl Recorder {
    pub(super) fn start(
        experiment: &Experiment,
        folder: Folder,
        manifest: Manifest,
    ) -> Result<Self, RecordError> {
        // First of all, so that whatever happens the folder is known to hold a recording.
        folder.write_text(MANIFEST, &manifest.to_ron())?;
        folder.write_text(&manifest.scenario, &experiment.text)?;
        copy_pictures(experiment, &manifest.pictures, &folder)?;
        Ok(Recorder {
            writer: Writer::start(folder.clone()),
            folder,
            ledger: manifest::LEDGER_HEAD.into(),
            sheet: Sheet::new(&manifest.title),
            manifest,
            expected: None,
            failed: None,
        })
    }

    /// Tells the recorder what the next frame is for.
    pub fn expect(&mut self, stop: Stop) {
        self.expected = Some(stop);
    }

    /// Whether writing has failed; `finish` says why.
    pub fn has_failed(&self) -> bool {
        self.failed.is_some()
    }

    fn give(&mut self, job: Job) {
        if !self.writer.give(job) {
            // The writer has stopped; what stopped it is told when it is joined.
            self.failed.get_or_insert(RecordError::Lost);
        }
    }

    /// Waits for the frames, and writes what is written last. Where a frame could not be written,
    /// those before it still make a valid recording, as far as there is room for one.
    pub(super) fn finish(self, complete: bool) -> Result<Manifest, RecordError> {
        let Recorder {
            folder,
            writer,
            mut manifest,
            ledger,
            sheet,
            failed,
            ..
        } = self;
        let written = match (writer.finish(), failed) {
            (Err(why), _) | (Ok(()), Some(why)) => Err(why),
            (Ok(()), None) => Ok(()),
        };
        let kept = |frame: &&Frame| folder.file(&frame.file).exists();
        let frames = manifest.frames.iter().take_while(kept).count();
        manifest.frames.truncate(frames);
        let lines: String = ledger.split_inclusive('\n').take(1 + frames).collect();
        let last = folder
            .write_text("ledger.csv", &lines)
            .and_then(|()| folder.write("sheet.png", |file| writer::encode(&sheet.draw(), file)));
        let all = written.and(last);
        manifest.complete = complete && all.is_ok();
        let told = folder.write_text(MANIFEST, &manifest.to_ron());
        all.and(told)?;
        Ok(manifest)
    }
}

/// The pictures that are copied with a scenario, so that the copy runs as well: those that lie beside
/// or below it. Others stay where they are.
pub(super) fn pictures_beside(experiment: &Experiment) -> Vec<String> {
    match experiment.origin {
        Origin::File(_) | Origin::Bundled => {
            let names: BTreeSet<String> = experiment.images.files().filter_map(below).collect();
            names.into_iter().collect()
        }
        Origin::Memory => Vec::new(),
    }
}

fn copy_pictures(
    experiment: &Experiment,
    pictures: &[String],
    folder: &Folder,
) -> Result<(), RecordError> {
    let beside = Beside::of(&experiment.origin);
    for name in pictures {
        folder.write(name, |to| {
            let bytes = beside.read(name).map_err(io::Error::other)?;
            to.write_all(&bytes)
        })?;
    }
    Ok(())
}

/// What the fields of a frame are taken from.
#[derive(bevy::ecs::system::SystemParam)]
pub(super) struct Dyed<'w> {
    pub experiment: Res<'w, TheExperiment>,
    pub cloth: Res<'w, Cloth>,
    pub free: Res<'w, FreeDye>,
    pub bound: Res<'w, BoundDye>,
    pub supplies: ResMut<'w, Supplies>,
}

/// The cloth as a recording shows it, where that is not flat.
#[derive(Resource)]
pub(super) struct Seen(pub Picture);

pub(super) fn keep(
    mut recorder: ResMut<Recorder>,
    clock: Res<ProcessClock>,
    ledger: Res<Ledger>,
    (flat, seen): (Res<Picture>, Option<Res<Seen>>),
    mut dyed: Dyed,
) {
    let Some(stop) = recorder.expected.take() else {
        return;
    };
    let picture = seen.as_ref().map_or(&*flat, |seen| &seen.0);
    // 3 · 0.1 h is 0.3 h and not 0.30000000000000004 h.
    let hours = rounded(clock.hours(), 12);
    if stop.sheet {
        let scenario = &dyed.experiment.scenario;
        let label = match &scenario.batik {
            Some(batik) => batik.told(clock.step, scenario.process.step_h),
            None => moment(clock.step, hours),
        };
        recorder.sheet.add(picture, label);
    }
    let Some(frame) = stop.frame else {
        return;
    };
    let name = frame_name(frame);
    recorder.give(Job::Picture {
        name: name.clone(),
        picture: picture.clone(),
    });
    if recorder.manifest.fields {
        if recorder.manifest.frames.is_empty() {
            let written = recorder.folder.write("cloth.npz", |file| {
                fields::write_cloth(
                    &dyed.cloth,
                    &dyed.experiment,
                    clock.splits_if_explicit,
                    file,
                )
            });
            if let Err(why) = written {
                recorder.failed.get_or_insert(why);
            }
        }
        let state = State::take(&mut dyed, clock.step, hours);
        recorder.give(Job::State {
            name: state_name(frame),
            state: Box::new(state),
        });
    }
    recorder.manifest.frames.push(Frame {
        file: name,
        step: clock.step,
        hours,
    });
    manifest::add_line(&mut recorder.ledger, clock.step, hours, &ledger);
}
