//! The drafts that come with the program: what they are drawn from, and that they are in good order.

use std::fs;

use dyelapse::cloth::WeaveMatrix;
use dyelapse::draft::wif::{read, write};
use dyelapse::draft::{Draft, Thread, bundled, floats};

#[test]
fn the_bundled_drafts_are_read_without_a_warning_and_are_in_good_order() {
    assert!(bundled().count() >= 4);
    for draft in bundled() {
        let reading = read(draft.name, draft.text.as_bytes()).unwrap();
        assert_eq!(reading.warnings, [], "{}", draft.name);
        assert!(
            reading
                .draft
                .notes()
                .iter()
                .any(|note| note.contains("MIT"))
        );
        let floats = floats(&reading.draft.drawdown());
        assert!(
            floats.iter().all(|floats| floats.unbound == 0),
            "{}",
            draft.name
        );
        assert_eq!(write(&reading.draft), draft.text, "{}", draft.name);
    }
}

/// Where the bundled drafts come from: `DYELAPSE_ACCEPT=1` writes them anew.
#[test]
fn the_bundled_drafts_are_what_they_are_drawn_from() {
    let accept = std::env::var_os("DYELAPSE_ACCEPT").is_some();
    for (name, draft) in drawings() {
        let path = format!("assets/drafts/{name}.wif");
        if accept {
            fs::write(&path, write(&draft)).unwrap();
        }
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text, write(&draft), "{path}");
    }
}

/// A thread of a colour, so far from the next and so thick, in mm.
fn yarn(colour: u32, spacing_mm: f64, thickness_mm: f64) -> Thread {
    let [_, r, g, b] = colour.to_be_bytes();
    Thread {
        colour: Some([r, g, b]),
        spacing_mm: Some(spacing_mm),
        thickness_mm: Some(thickness_mm),
    }
}

/// A draft of what a treadling lifts of a threading. Threads are numbered from the left and the top;
/// `lifts[i]` are the shafts of treadle i, `warp` and `weft` give each thread by its number.
fn draft(
    (title, note): (&str, &str),
    threading: &[u8],
    (lifts, treadling): (&[&[u8]], &[usize]),
    (ends, picks): (usize, usize),
    warp: impl Fn(usize) -> Thread,
    weft: impl Fn(usize) -> Thread,
) -> Draft {
    let weave = WeaveMatrix::from_rule(threading.len() as u32, treadling.len() as u32, |e, p| {
        lifts[treadling[p as usize]].contains(&threading[e as usize])
    });
    let warp = (0..ends).map(warp).collect();
    let weft = (0..picks).map(weft).collect();
    Draft::of_weave(&weave, warp, weft)
        .unwrap()
        .with_title(title)
        .with_author("The dyelapse authors")
        .with_notes([note, "Drawn for dyelapse; MIT or Apache-2.0, as you like."])
}

/// Structures that everyone may weave, in colours of our own.
fn drawings() -> Vec<(&'static str, Draft)> {
    let twill: &[&[u8]] = &[&[1, 2], &[2, 3], &[3, 4], &[4, 1]];
    let (black, cream) = (0x1d1b1a, 0xf3ead8);
    let four_and_four = |i: usize| yarn(if i % 8 < 4 { black } else { cream }, 0.9, 0.85);
    let (cells, fine) = (8, 0.7);
    vec![
        (
            "houndstooth",
            draft(
                (
                    "Houndstooth",
                    "2/2 twill, four dark and four light threads both ways.",
                ),
                &[1, 2, 3, 4],
                (twill, &[0, 1, 2, 3]),
                (24, 24),
                four_and_four,
                four_and_four,
            ),
        ),
        (
            "herringbone",
            draft(
                (
                    "Herringbone tweed",
                    "2/2 twill that breaks off and turns every eight ends.",
                ),
                &[1, 2, 3, 4, 1, 2, 3, 4, 2, 1, 4, 3, 2, 1, 4, 3],
                (twill, &[0, 1, 2, 3]),
                (48, 32),
                |_| yarn(0x4b4a4d, 1.1, 1.05),
                |p| yarn(if p % 16 == 0 { 0x8c5a3c } else { 0xb9b0a2 }, 1.1, 1.05),
            ),
        ),
        (
            "goose_eye",
            draft(
                (
                    "Goose eye",
                    "2/2 twill, pointed both ways: lozenges within lozenges.",
                ),
                &[1, 2, 3, 4, 1, 2, 3, 4, 1, 4, 3, 2, 1, 4, 3, 2],
                (twill, &[0, 1, 2, 3, 0, 1, 2, 3, 0, 3, 2, 1, 0, 3, 2, 1]),
                (48, 48),
                |_| yarn(0xefe7d6, 0.8, 0.75),
                |_| yarn(0x2b4a7f, 0.75, 0.75),
            ),
        ),
        (
            "waffle",
            draft(
                (
                    "Waffle",
                    "Floats of warp and of weft around hollows, on five shafts.",
                ),
                &[1, 2, 3, 4, 5, 4, 3, 2],
                (
                    &[&[5], &[4], &[3, 5], &[2, 4, 5], &[1, 3, 4, 5]],
                    &[0, 1, 2, 3, 4, 3, 2, 1],
                ),
                (40, 40),
                |e| yarn(if e % 8 == 4 { 0x7d9476 } else { 0xe9e0cb }, 1.5, 1.3),
                |p| yarn(if p % 8 == 0 { 0x7d9476 } else { 0xe9e0cb }, 1.5, 1.3),
            ),
        ),
        (
            "honeycomb",
            draft(
                (
                    "Honeycomb",
                    "Cells of plain weave, in turn; two thick picks bend around them.",
                ),
                &[1, 2, 1, 2, 1, 2, 1, 2, 3, 4, 3, 4, 3, 4, 3, 4],
                (
                    &[
                        &[1, 3],
                        &[2, 4],
                        &[1, 3, 4],
                        &[2, 3, 4],
                        &[1, 2, 3],
                        &[1, 2, 4],
                    ],
                    &[0, 1, 2, 3, 2, 3, 2, 3, 2, 3, 0, 1, 4, 5, 4, 5, 4, 5, 4, 5],
                ),
                (48, 40),
                |_| yarn(0xe8dfce, 1.0, 0.7),
                move |p| match p % 20 {
                    0 | 1 | 10 | 11 => yarn(0xf6f1e7, 2.2, 2.0),
                    p if p < 2 + cells => yarn(0x9a3b3a, 0.8, fine),
                    _ => yarn(0xc58b3b, 0.8, fine),
                },
            ),
        ),
        (
            "log_cabin",
            draft(
                (
                    "Log cabin",
                    "Plain weave; dark and light threads take turns, and change places every 8th.",
                ),
                &[1, 2],
                (&[&[1], &[2]], &[0, 1]),
                (48, 48),
                |e| log(e, 1.4, 0.8),
                |p| log(p, 1.4, 0.8),
            ),
        ),
    ]
}

/// Dark and light in turn; from one block of eight to the next they change places. Dark is thick.
fn log(i: usize, thick: f64, thin: f64) -> Thread {
    if i % 2 == i / 8 % 2 {
        yarn(0x4a2f22, thick, thick - 0.1)
    } else {
        yarn(0xe7d3b0, thin, thin - 0.1)
    }
}
