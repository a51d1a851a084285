//! What may be typed. What it means is in `commands`.

use std::path::PathBuf;

use clap::{Parser, Subcommand};
use clap_complete::Shell;

/// Simulates how cloth is dyed, yarn by yarn, and records it as a time-lapse.
#[derive(Debug, Parser)]
#[command(
    version,
    arg_required_else_help = true,
    after_help = "\
Begin with:
  dyelapse list                     see the scenarios that come with the program
  dyelapse record one_drop          record the smallest one, in about a second
  dyelapse record my_cloth.ron      record your own

A scenario is a text file. Copy a bundled one from a recording's folder and change it;
`dyelapse check` tells whether it is right."
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What can be done.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Dye a cloth and record it as a time-lapse
    ///
    /// Writes a folder: frame_00000.png and on, sheet.png with the chosen moments side by side,
    /// recording.ron (what each file shows), ledger.csv (where all dye is at every frame) and the
    /// scenario itself. Ctrl-C ends early and leaves a valid, shorter recording.
    #[command(after_help = "\
Examples:
  dyelapse record seikaiha
  dyelapse record one_drop --scale 8 --out drop
  dyelapse record seikaiha --steps 12500 --frames 100 --video
  dyelapse record fig9b --fields       also for NumPy: numpy.load('state_00000.npz')
  dyelapse record seikaiha_hanging --view draped
  dyelapse record kasuri --view draped --drape tablecloth --size 1280x960")]
    Record(Record),
    /// Write the draped cloth of one moment as glTF 2.0, for Blender and other modelling programs
    ///
    /// One binary file with both sides of the cloth: mesh, normals, the dyed yarns as picture and their
    /// relief as normal map. Metres, y up. Needs no graphics driver.
    #[command(after_help = "\
Examples:
  dyelapse export batik_tablecloth
  dyelapse export kasuri --drape ball --step 2000 --out kasuri.glb")]
    Export(Export),
    /// Make one labelled picture of several scenarios, or of a figure
    ///
    /// A figure lists panels: scenarios, and what to show of each. Those of the papers come with the
    /// program; `dyelapse list` names them.
    #[command(after_help = "\
Examples:
  dyelapse sheet fig8                  the figure of the paper
  dyelapse sheet fig10a fig10b fig10c --columns 3 --out weaves.jpg
  dyelapse sheet my_cloth.ron --steps 1000 --scale 4")]
    Sheet(Sheet),
    /// Tell whether scenarios and figures are right, without running them
    Check {
        /// Files of scenarios or figures, or names of bundled ones
        #[arg(required = true, value_name = "NAME")]
        scenarios: Vec<String>,
    },
    /// List the scenarios, figures and drafts that come with the program
    List,
    /// Sum up a weaving draft (WIF), or write the weave of a scenario as one
    ///
    /// Of a draft it tells threads, loom, colours, measures, floats, and what is odd about the file;
    /// with --out it also writes it anew, in good order. Of a scenario it prints the WIF, or writes it
    /// to --out.
    #[command(after_help = "\
Examples:
  dyelapse wif houndstooth
  dyelapse wif old.wif --out clean.wif
  dyelapse wif fig10b --out twill.wif")]
    Wif(Wif),
    /// Find warp and weft in a photograph of woven cloth
    ///
    /// Makes the mask that photo mode needs: blue (0,0,255) where the warp lies on top, red
    /// (255,0,0) where the weft does. The warp must run down the photograph, within 12°. Says what it
    /// saw and how much of it is doubtful; correct the mask by hand in any paint program.
    #[command(after_help = "\
Examples:
  dyelapse segment linen.jpg                     writes linen_mask.png
  dyelapse segment linen.jpg --doubt doubt.png   also shows where to look twice
  dyelapse segment denim.jpg --weave twill3/1    the weave is known
  dyelapse segment fine.png --pitch 3.5,5.3      pixels from yarn to yarn, if they are not found")]
    Segment(Segment),
    /// Measure the colours of dyed cloth on a photograph
    ///
    /// Prints the lightest, the middle and the darkest colour as a scenario's look has them.
    #[command(after_help = "\
Examples:
  dyelapse palette indigo.jpg
  dyelapse palette indigo.jpg --region 100,50,400,300 --swatch colours.png")]
    Palette(Palette),
    /// Print the completions of a shell
    ///
    /// For bash: dyelapse completions bash > ~/.local/share/bash-completion/completions/dyelapse
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// How a recording shows the cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum View {
    /// Every cell in its place
    Flat,
    /// Hanging, lying, falling: in the light of a studio
    Draped,
}

/// Reads `1280x960`.
fn pixels(text: &str) -> Result<(u32, u32), String> {
    let wrong = || format!("a size is written as 1280x960, but this is {text}");
    let (width, height) = text.split_once(['x', '×']).ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse().map_err(|_| wrong());
    Ok((number(width)?, number(height)?))
}

/// `dyelapse record`.
#[derive(Debug, clap::Args)]
pub struct Record {
    /// A scenario file, or the name of a bundled scenario
    #[arg(value_name = "SCENARIO")]
    pub scenario: String,
    /// Folder for the recording [default: recordings/NAME]
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Frames of the time-lapse, evenly spread [default: what the scenario says]
    #[arg(long, value_name = "N")]
    pub frames: Option<u32>,
    /// End after so many steps [default: what the scenario says]
    #[arg(long, value_name = "N")]
    pub steps: Option<u64>,
    /// Pixels along one side of a cell [default: what the scenario says]
    #[arg(long, value_name = "K")]
    pub scale: Option<u32>,
    /// Also write NumPy archives: cloth.npz, and state_00000.npz for every frame
    #[arg(long)]
    pub fields: bool,
    /// Also write height.png and normal.png, the relief of the undyed cloth, for a renderer
    #[arg(long)]
    pub maps: bool,
    /// Show the cloth flat, or draped in a studio; the latter needs a graphics driver
    #[arg(long, value_enum, default_value_t = View::Flat)]
    pub view: View,
    /// How to drape it: a bundled drape, or a file of one [default: what the scenario says]
    #[arg(long, value_name = "NAME")]
    pub drape: Option<String>,
    /// Pixels of a frame of draped cloth, such as 1280x960 [default: what the scenario says]
    #[arg(long, value_name = "WxH", value_parser = pixels)]
    pub size: Option<(u32, u32)>,
    /// Also make video.mp4 of the frames; needs ffmpeg
    #[arg(long)]
    pub video: bool,
    /// Replace the recording that is already in the folder
    #[arg(long)]
    pub force: bool,
    /// Say nothing but errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// `dyelapse export`.
#[derive(Debug, clap::Args)]
pub struct Export {
    /// A scenario file, or the name of a bundled scenario
    #[arg(value_name = "SCENARIO")]
    pub scenario: String,
    /// The file to write [default: NAME.glb]
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// The step of the process [default: its last]
    #[arg(long, value_name = "N")]
    pub step: Option<u64>,
    /// How to drape it: a bundled drape, or a file of one [default: what the scenario says]
    #[arg(long, value_name = "NAME")]
    pub drape: Option<String>,
    /// Pixels along one side of a cell [default: what the scenario says]
    #[arg(long, value_name = "K")]
    pub scale: Option<u32>,
    /// Replace the file if it is there
    #[arg(long)]
    pub force: bool,
    /// Say nothing but errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// `dyelapse wif`.
#[derive(Debug, clap::Args)]
pub struct Wif {
    /// A draft (a .wif file, or the name of a bundled one), or a scenario
    #[arg(value_name = "DRAFT or SCENARIO")]
    pub what: String,
    /// Write a WIF to this file
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Replace the file if it is there
    #[arg(long)]
    pub force: bool,
}

/// `dyelapse sheet`.
#[derive(Debug, clap::Args)]
pub struct Sheet {
    /// Files of figures or scenarios, or names of bundled ones
    #[arg(required = true, value_name = "NAME")]
    pub names: Vec<String>,
    /// The picture, .png or .jpg [default: NAME.png]
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Panels in a row [default: what the figure says]
    #[arg(long, value_name = "N")]
    pub columns: Option<u32>,
    /// Show every cloth after so many steps [default: what the figure says, or the end]
    #[arg(long, value_name = "N")]
    pub steps: Option<u64>,
    /// Pixels along one side of a cell [default: what figure and scenario say]
    #[arg(long, value_name = "K")]
    pub scale: Option<u32>,
    /// Replace the picture that is already there
    #[arg(long)]
    pub force: bool,
    /// Say nothing but errors
    #[arg(long, short)]
    pub quiet: bool,
}

/// `dyelapse palette`.
#[derive(Debug, clap::Args)]
pub struct Palette {
    /// A photograph of dyed cloth, PNG or JPEG
    #[arg(value_name = "PHOTO")]
    pub photo: PathBuf,
    /// The part that counts: left, top, width and height in pixels [default: all of it]
    #[arg(long, value_name = "X,Y,W,H")]
    pub region: Option<String>,
    /// Also draw the colours from undyed to fully dyed
    #[arg(long, value_name = "FILE.png")]
    pub swatch: Option<PathBuf>,
    /// Replace the file if it is there
    #[arg(long)]
    pub force: bool,
}

/// `dyelapse segment`.
#[derive(Debug, clap::Args)]
pub struct Segment {
    /// A photograph of woven cloth, PNG or JPEG
    #[arg(value_name = "PHOTO")]
    pub photo: PathBuf,
    /// The mask [default: PHOTO_mask.png beside the photograph]
    #[arg(long, short, value_name = "MASK.png")]
    pub out: Option<PathBuf>,
    /// Also draw the photograph in grey with doubtful pixels in yellow
    #[arg(long, value_name = "FILE.png")]
    pub doubt: Option<PathBuf>,
    /// Also draw the photograph tinted with the mask
    #[arg(long, value_name = "FILE.png")]
    pub overlay: Option<PathBuf>,
    /// The weave, if it is known: plain, twill2/1, satin5/2, basket2, or drawn as XX.,.XX,X.X
    #[arg(long, value_name = "WEAVE")]
    pub weave: Option<String>,
    /// Pixels from warp yarn to warp yarn and from weft yarn to weft yarn, if they are known
    #[arg(long, value_name = "WARP,WEFT")]
    pub pitch: Option<String>,
    /// Replace files that are already there
    #[arg(long)]
    pub force: bool,
}
