//! WIF 1.1, the Weaving Information File: the text format that weaving programs exchange drafts in
//! (Nielsen, Keates, Sinkler and others, 1996 and 1997).
//!
//! A WIF is a list of sections, `[NAME]`, with lines `key=value` in any order. Every thread begins
//! with what `[WARP]` or `[WEFT]` says of all; sections such as `[WARP COLORS]` then say of single
//! threads, by number, what is different.
//!
//! | section | says |
//! |---|---|
//! | `[WEAVING]` | how many shafts and treadles; whether the shed rises |
//! | `[THREADING]` | the shafts of each end |
//! | `[TIEUP]`, `[TREADLING]` | the shafts of each treadle, the treadles of each pick |
//! | `[LIFTPLAN]` | the shafts of each pick, in place of those two |
//! | `[WARP]`, `[WEFT]` | how many threads; colour, spacing, thickness, and their units |
//! | `[WARP COLORS]`, `[WARP SPACING]`, `[WARP THICKNESS]`, and for the weft | of single threads |
//! | `[COLOR PALETTE]`, `[COLOR TABLE]` | the range of colour values, the colours by number |
//! | `[TEXT]`, `[NOTES]` | title, author, notes |
//!
//! Files in the wild are sloppy, and [`read()`] is lenient by one rule: what would change the weave and
//! cannot be understood is an error; what is about looks, or can be understood although it is wrong,
//! is a warning. `docs/drafts.md` lists the cases. [`write()`] is strict.

mod counts;
mod looks;
mod read;
mod text;
mod values;
mod write;

pub use read::read;
pub use write::write;
