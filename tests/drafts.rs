//! Drafts: what is written is read again, what is sloppy is understood, what is wrong is told.

use std::collections::BTreeSet;

use dyelapse::cloth::WeaveMatrix;
use dyelapse::draft::wif::{read, write};
use dyelapse::draft::{Draft, Lifting, Reading, Shed, Thread};
use proptest::prelude::*;

/// A draft with a little of everything: 5 ends on 4 shafts, 6 picks, 3 treadles.
const GOOD: &str = "\
[WIF]
Version=1.1
[CONTENTS]
TEXT=true
WEAVING=true
WARP=true
WEFT=true
COLOR TABLE=true
COLOR PALETTE=true
THREADING=true
TIEUP=true
TREADLING=true
WARP COLORS=true
WEFT SPACING=true
[TEXT]
Title=Good; draft
[WEAVING]
Shafts=4
Treadles=3
Rising Shed=true
[WARP]
Threads=5
Color=1
Spacing=0.2
Units=centimeters
[WEFT]
Threads=6
Color=2
Spacing=0.1
Thickness=0.08
Units=centimeters
[COLOR PALETTE]
Range=0,255
[COLOR TABLE]
1=255,0,0
2=0,128,255
3=10,20,30
[WARP COLORS]
2=3
4=2
[WEFT SPACING]
6=0.3
[THREADING]
1=1
2=2
3=3
4=4
5=1,3
[TIEUP]
1=1,2
2=3
3=1,4
[TREADLING]
1=1
2=2
3=3
4=1,2
5=0
6=3
";

/// What is drawn of it: ends from the left (5 first), picks from the top (1 first).
const DRAWN: [&str; 6] = ["X..XX", "X.X..", "XX..X", "X.XXX", ".....", "XX..X"];

fn reading(text: &str) -> Reading {
    read("draft.wif", text.as_bytes()).unwrap_or_else(|why| panic!("{why}\n{text}"))
}

fn refused(text: &str) -> String {
    match read("draft.wif", text.as_bytes()) {
        Ok(_) => panic!("this should not be read:\n{text}"),
        Err(why) => why.to_string(),
    }
}

fn warnings(reading: &Reading) -> Vec<String> {
    reading.warnings.iter().map(ToString::to_string).collect()
}

fn drawn(weave: &WeaveMatrix) -> Vec<String> {
    let up = |e, p| if weave.warp_up(e, p) { 'X' } else { '.' };
    (0..weave.picks())
        .map(|p| (0..weave.ends()).map(|e| up(e, p)).collect())
        .collect()
}

/// The good draft with one line of a section put in place of another.
fn with(section: &str, line: &str, instead: &str) -> String {
    let (before, rest) = GOOD.split_once(&format!("[{section}]\n")).unwrap();
    let (between, after) = rest.split_once(&format!("{line}\n")).unwrap();
    assert!(!between.contains('['), "{line} is not in {section}");
    format!("{before}[{section}]\n{between}{instead}\n{after}")
}

/// What is told of a line: `[SECTION] line: why`, with the file and the number of that line in front,
/// the last one if it comes twice. What is about the whole file has its name in front already.
fn told_of(text: &str, what: &str) -> String {
    let Some((section, rest)) = what
        .strip_prefix('[')
        .and_then(|what| what.split_once("] "))
    else {
        return what.to_owned();
    };
    let (wanted, _) = rest.split_once(": ").unwrap();
    let mut current = "";
    let mut found = 0;
    for (i, line) in text.lines().enumerate() {
        match line.strip_prefix('[') {
            Some(head) => current = head.trim_end_matches(']'),
            None if current == section && line == wanted => found = i + 1,
            None => {}
        }
    }
    format!("draft.wif:{found}: {what}")
}

#[test]
fn a_good_draft_is_read_as_it_is_meant_and_without_warnings() {
    let reading = reading(GOOD);
    assert_eq!(warnings(&reading), [""; 0]);
    let draft = &reading.draft;
    assert_eq!(draft.title(), "Good; draft");
    assert_eq!((draft.shafts(), draft.treadles()), (4, 3));
    assert_eq!(drawn(&draft.drawdown()), DRAWN);
    let colours: Vec<_> = draft.warp().iter().map(|end| end.colour).collect();
    let [red, blue, dark] = [[255, 0, 0], [0, 128, 255], [10, 20, 30]].map(Some);
    assert_eq!(colours, [red, blue, red, dark, red]);
    assert!(draft.weft().iter().all(|pick| pick.colour == blue));
    let spacing: Vec<_> = draft.weft().iter().map(|pick| pick.spacing_mm).collect();
    assert_eq!(spacing[4..], [Some(1.0), Some(3.0)]);
    assert_eq!(draft.weft()[5].thickness_mm, Some(0.8));
    assert_eq!(draft.warp()[0].spacing_mm, Some(2.0));
    assert_eq!(draft.warp()[0].thickness_mm, None);
}

/// Sections in another order.
fn shuffled() -> String {
    let mut sections: Vec<String> = GOOD
        .split("\n[")
        .skip(1)
        .map(|section| format!("\n[{}", section.trim_end()))
        .collect();
    sections.reverse();
    format!("[WIF]{}\n", sections.concat())
}

#[test]
fn sloppy_files_are_the_same_draft() {
    let good = reading(GOOD).draft;
    let fields = |text: &str| text.replace('=', "  =\t");
    let inline = GOOD.replace("2=3\n", "2=3 ; comment\n");
    let twice = GOOD.replace("[TIEUP]\n", "[TIEUP]\n1=1,2\n[NOTES]\n[TIEUP]\n");
    for (how, text) in [
        ("line ends of Windows", GOOD.replace('\n', "\r\n")),
        ("line ends of old Macs", GOOD.replace('\n', "\r")),
        ("mixed line ends", GOOD.replacen("\n", "\r\n", 30)),
        ("a byte order mark", format!("\u{feff}{GOOD}")),
        ("blanks around", fields(GOOD)),
        ("indented", GOOD.replace('\n', "\n  ")),
        ("blank lines", GOOD.replace('\n', "\n\n")),
        ("no line end at the end", GOOD.trim_end().to_owned()),
        ("sections in another order", shuffled()),
        ("comments", GOOD.replace('\n', "\n; [THREADING]\n;1=4\n")),
        ("comments behind values", inline),
        ("comments behind heads", GOOD.replace("]\n", "] ; head\n")),
        ("a section twice", twice),
        ("a key twice", with("TREADLING", "3=3", "3=1\n3=3")),
        ("text before", format!("Dear weaver,\n1=2\n\n{GOOD}")),
        ("a section before", format!("[OTHER]\nx\n{GOOD}")),
        ("lines without =", GOOD.replace("]\n", "]\nnonsense\n")),
        (
            "keys that are no numbers",
            GOOD.replace("[TIEUP]\n", "[TIEUP]\nx=1\n0=2\n-1=3\n"),
        ),
        (
            "private sections",
            GOOD.replace("[TIEUP]", "[PRIVATE MINE TIEUP]\n1=4\nx\n[TIEUP]"),
        ),
        (
            "symbols",
            format!("{GOOD}[WARP SYMBOLS]\n1='x'\n[TRANSLATIONS]\nx\n"),
        ),
        (
            "contents all false",
            GOOD.replacen("=true\n", "=false\n", 11),
        ),
        (
            "no contents",
            GOOD.replace("=true\n", "=\n").replace("Shed=", "Shed=1"),
        ),
        (
            "contents that are not there",
            with("CONTENTS", "TEXT=true", "TEXT=true\nLIFTPLAN=true"),
        ),
        ("too few threads", with("WARP", "Threads=5", "Threads=2")),
        ("no threads", with("WARP", "Threads=5", "Threads=")),
        ("too few shafts", with("WEAVING", "Shafts=4", "Shafts=1")),
        (
            "no shafts nor treadles",
            GOOD.replace("Shafts=4\nTreadles=3\n", ""),
        ),
        ("zeros in lists", with("TREADLING", "4=1,2", "4=0,1,2,0")),
        (
            "lists with blanks",
            with("TREADLING", "4=1,2", "4= 2 ,, 1,1"),
        ),
        ("a pick without a treadle", with("TREADLING", "5=0", "5=")),
        ("decimal commas", GOOD.replace("0.", "0,")),
        (
            "other words for true",
            with("WEAVING", "Rising Shed=true", "Rising Shed=YES"),
        ),
        (
            "no word on the shed",
            with("WEAVING", "Rising Shed=true", ""),
        ),
        (
            "British spelling",
            GOOD.replace("COLOR", "Colour")
                .replace("centimeters", "Centimetres"),
        ),
        ("an empty liftplan", format!("{GOOD}[LIFTPLAN]\n1=\n")),
        ("a blank liftplan", format!("{GOOD}[LIFTPLAN]\n1=0\n2=0\n")),
        (
            "the colour's values repeated",
            with("WARP COLORS", "2=3", "2=3,10,20,30"),
        ),
        ("colours by value", with("WARP COLORS", "2=3", "2=10,20,30")),
        (
            "a colour for no end",
            with("WARP COLORS", "4=2", "4=2\n77=1"),
        ),
    ] {
        let read = reading(&text).draft;
        assert_eq!(
            read,
            good.clone().with_notes(read.notes().iter().map(|n| &**n)),
            "{how}"
        );
    }
    // Case and Latin-1 change the title, and nothing else.
    let lower = reading(&GOOD.to_lowercase()).draft;
    assert_eq!(lower.with_title("Good; draft"), good);
    let bytes: Vec<u8> = with("TEXT", "Title=Good; draft", "Title=Gr\u{f6}\u{df}e \u{a7}1")
        .chars()
        .map(|c| c as u8)
        .collect();
    let latin = read("latin.wif", &bytes).unwrap().draft;
    assert_eq!(latin.title(), "Größe §1");
    assert_eq!(latin.with_title("Good; draft"), good);
}

#[test]
fn what_had_to_be_guessed_is_told_with_its_line() {
    for (text, told) in [
        (
            with("WARP COLORS", "2=3", "2=9"),
            "[WARP COLORS] 2=9: [COLOR TABLE] has no such colour; it is read as white",
        ),
        (
            with("WARP COLORS", "2=3", "2=0"),
            "[WARP COLORS] 2=0: [COLOR TABLE] has no such colour; it is read as white",
        ),
        (
            with("COLOR TABLE", "2=0,128,255", "2=0,128,256"),
            "[COLOR TABLE] 2=0,128,256: colour values go from 0 to 255 here; the \
             nearest is taken",
        ),
        (
            with("WEFT SPACING", "6=0.3", "6=wide"),
            "[WEFT SPACING] 6=wide: a measure is a number over 0, up to 1000 mm; it is \
             left out",
        ),
        (
            with("THREADING", "4=4", "4=4\nnonsense"),
            "[THREADING] nonsense: there is no `=`; the line is passed over",
        ),
        (
            with("THREADING", "4=4", "4=3\n4=4"),
            "[THREADING] 4=4: line 47 says otherwise (3); this one counts",
        ),
        (
            with("WARP", "Threads=5", "Threads=3"),
            "[WARP] Threads=3: there are 5 ends; that is how many are read",
        ),
        (
            with("WARP", "Threads=5", "Threads=9"),
            "draft.wif: [THREADING] leaves out ends 6 to 9; they are on no shaft",
        ),
        (
            with("WEAVING", "Shafts=4", "Shafts=3"),
            "[THREADING] 4=4: line 18 says that there are 3 shafts; it is read as 4",
        ),
        (
            with("TREADLING", "4=1,2", "4=1,7"),
            "[TREADLING] 4=1,7: treadle 7 is tied to nothing and lifts nothing",
        ),
        (
            with("CONTENTS", "TEXT=true", "NOTES=true"),
            "[CONTENTS] NOTES=true: there is no such section",
        ),
        (
            with("CONTENTS", "TIEUP=true", "TIEUP=false"),
            "[CONTENTS] TIEUP=false: there is such a section, and it counts",
        ),
        (
            with("WARP", "Units=centimeters", "Units=cemtimeters"),
            "[WARP] Units=cemtimeters: it is read as centimeters",
        ),
        (
            format!("{GOOD}[LIFTPLAN]\n1=1,2\n2=3\n3=1,4\n4=1,2,3\n5=0\n6=1,4\n"),
            "draft.wif: there are a [LIFTPLAN] and a [TIEUP] with [TREADLING]; the [LIFTPLAN] is \
             used, and both weave the same",
        ),
        (
            format!("{GOOD}[LIFTPLAN]\n1=4\n2=3\n3=1\n4=1\n5=0\n6=1\n"),
            "draft.wif: there are a [LIFTPLAN] and a [TIEUP] with [TREADLING]; the [LIFTPLAN] is \
             used, and the other would weave something else",
        ),
        (
            GOOD.replace("[WIF]\n", ""),
            "draft.wif: there is no [WIF] section; it is read as a WIF nevertheless",
        ),
    ] {
        assert_eq!(
            warnings(&reading(&text)).first(),
            Some(&told_of(&text, told))
        );
    }
}

#[test]
fn a_file_full_of_mistakes_is_told_of_in_a_few_lines() {
    let colours: String = (1..=5).map(|end| format!("{end}=9{end}\n")).collect();
    let text = GOOD.replace(
        "[WARP COLORS]\n2=3\n4=2\n",
        &format!("[WARP COLORS]\n{colours}"),
    );
    let warnings = warnings(&reading(&text));
    assert_eq!(warnings.len(), 1);
    assert!(
        warnings[0].ends_with("(and 4 more lines like it)"),
        "{warnings:?}"
    );
}

#[test]
fn what_cannot_be_woven_is_refused_with_its_line() {
    let without = |section: &str| {
        let (before, rest) = GOOD.split_once(&format!("\n[{section}]\n")).unwrap();
        let rest = rest
            .split_once("\n[")
            .map_or(String::new(), |(_, rest)| format!("\n[{rest}"));
        format!("{before}{rest}")
    };
    for (text, why) in [
        (
            String::new(),
            "draft.wif: this is no WIF: there is no [WIF] section",
        ),
        (
            "\u{0}\u{1}PNG".into(),
            "draft.wif: this is no WIF: there is no [WIF] section",
        ),
        (
            with("THREADING", "5=1,3", "5=x"),
            "[THREADING] 5=x: a shaft is a whole number from 0 to 4, but this has \"x\"",
        ),
        (
            with("TIEUP", "3=1,4", "3=1,-4"),
            "[TIEUP] 3=1,-4: a shaft is a whole number from 0 to 4, but this has \"-4\"",
        ),
        (
            with("TREADLING", "4=1,2", "4=1.5"),
            "[TREADLING] 4=1.5: a treadle is a whole number from 0 to 3, but this has \
             \"1.5\"",
        ),
        (
            with("THREADING", "5=1,3", "5=5000"),
            "[THREADING] 5=5000: a draft has at most 4096 shafts",
        ),
        (
            with("THREADING", "5=1,3", "99999999999999999999999=1"),
            "[THREADING] 99999999999999999999999=1: a draft has at most 4096 ends",
        ),
        (
            with("WEFT", "Threads=6", "Threads=1000000000"),
            "[WEFT] Threads=1000000000: a draft has at most 4096 of them",
        ),
        (
            with("WEFT", "Threads=6", "Threads=many"),
            "[WEFT] Threads=many: a whole number is needed",
        ),
        (
            with("WEAVING", "Rising Shed=true", "Rising Shed=maybe"),
            "[WEAVING] Rising Shed=maybe: true or false is needed",
        ),
        (
            without("THREADING"),
            "draft.wif: there is no [THREADING], which says what shaft each end is on",
        ),
        (
            without("TIEUP"),
            "draft.wif: there is a [TREADLING] but no [TIEUP], which says what shafts each treadle \
             lifts, nor a [LIFTPLAN]",
        ),
        (
            without("TREADLING"),
            "draft.wif: there is a [TIEUP] but no [TREADLING], which says what treadles each pick \
             presses, nor a [LIFTPLAN]",
        ),
        (
            without("COLOR TABLE"),
            "[WARP] Color=1: there is no [COLOR TABLE], which says what colour that is",
        ),
    ] {
        assert_eq!(refused(&text), told_of(&text, why));
    }
}

#[test]
fn colours_of_any_range_are_the_same_colours() {
    for (range, most) in [
        ("Range=0,999", 999),
        ("Range=0,65535", 65535),
        ("Range=0,1", 1),
    ] {
        let half = most as f64 / 2.0;
        let text = with("COLOR PALETTE", "Range=0,255", range)
            .replace("1=255,0,0", &format!("1={most},0,0"))
            .replace("2=0,128,255", &format!("2=0,{half},{most}"))
            .replace("3=10,20,30", "3=0,0,0");
        let draft = reading(&text).draft;
        assert_eq!(draft.warp()[0].colour, Some([255, 0, 0]), "{range}");
        assert_eq!(draft.weft()[0].colour, Some([0, 128, 255]), "{range}");
        // Where the range is left out, the values tell.
        if most > 1 {
            assert_eq!(reading(&text.replace(range, "")).draft, draft, "{range}");
        }
    }
}

#[test]
fn units_are_those_of_the_file() {
    for (units, mm) in [
        ("Inches", 25.4),
        ("decipoints", 25.4 / 720.0),
        ("CM", 10.0),
        ("", 10.0),
    ] {
        let text = GOOD.replace("Units=centimeters", &format!("Units={units}"));
        let draft = reading(&text.replace("Spacing=0.2", "Spacing=2")).draft;
        let spacing = draft.warp()[0].spacing_mm.unwrap();
        assert!((spacing - 2.0 * mm).abs() < 1e-6, "{units}: {spacing}");
    }
    // One direction without units has those of the other.
    let text = GOOD.replacen("Units=centimeters", "Units=inches", 1);
    let draft = reading(&text.replace("Units=centimeters", "")).draft;
    assert_eq!(draft.weft()[0].spacing_mm, Some(2.54));
}

fn thread() -> impl Strategy<Value = Thread> {
    let measure = || prop::option::of(prop_oneof![0.001..900.0_f64, Just(2.54), Just(0.1)]);
    let colour = prop_oneof![Just([0; 3]), Just([255, 0, 7]), any::<[u8; 3]>()];
    (prop::option::weighted(0.9, colour), measure(), measure()).prop_map(
        |(colour, spacing_mm, thickness_mm)| Thread {
            colour,
            spacing_mm,
            thickness_mm,
        },
    )
}

/// Threads that are all alike, or all different.
fn threads(most: usize) -> impl Strategy<Value = Vec<Thread>> {
    prop_oneof![
        prop::collection::vec(thread(), 1..=most),
        (thread(), 1..=most).prop_map(|(thread, n)| vec![thread; n]),
    ]
}

/// A draft of any weave: a small repeat, or one as large as the draft.
fn any_draft() -> impl Strategy<Value = Draft> {
    let weave =
        (1..60_u32, 1..60_u32, any::<u64>(), 0..3_u32).prop_map(|(ends, picks, seed, thin)| {
            WeaveMatrix::from_rule(ends, picks, |e, p| {
                // A mix of bits, sparse or dense, that depends on both.
                let mut x = seed ^ (u64::from(e) << 32 | u64::from(p));
                for _ in 0..3 {
                    x = (x ^ (x >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                }
                (x >> 40) % 4 > u64::from(thin)
            })
        });
    let draft = (weave, threads(70), threads(70), "\\PC{0,20}", any::<bool>());
    draft.prop_map(|(weave, warp, weft, title, by_liftplan)| {
        let draft = Draft::of_weave(&weave, warp, weft).unwrap();
        let draft = draft
            .with_title(&title)
            .with_notes([title.as_str(), "", "x=1;2"]);
        if by_liftplan {
            draft.with_liftplan()
        } else {
            draft
        }
    })
}

/// A draft as a file may have it: any threading, tie-up and treadling, several at a time or none.
fn any_file() -> impl Strategy<Value = String> {
    let list = |most: u16| prop::collection::vec(0..=most, 0..4);
    let lists = move |most, n| prop::collection::vec(list(most), 1..n);
    (lists(9, 20), lists(9, 12), lists(12, 20), any::<bool>()).prop_map(
        |(threading, tieup, treadling, rising)| {
            let section = |name: &str, lists: &[Vec<u16>]| {
                let mut text = format!("[{name}]\n");
                for (i, list) in lists.iter().enumerate() {
                    let words: Vec<String> = list.iter().map(u16::to_string).collect();
                    text.push_str(&format!("{}={}\n", i + 1, words.join(",")));
                }
                // Whatever the lists are, none of the sections is empty.
                text + &format!("{}=1\n", lists.len() + 1)
            };
            format!(
                "[WIF]\n[WEAVING]\nRising Shed={rising}\n{}{}{}",
                section("THREADING", &threading),
                section("TIEUP", &tieup),
                section("TREADLING", &treadling)
            )
        },
    )
}

/// The drawdown by its definition, shaft by shaft, without the library's way of doing it.
fn by_definition(draft: &Draft) -> Vec<String> {
    let lifted = |p: usize| -> BTreeSet<u16> {
        match draft.lifting() {
            Lifting::Liftplan(picks) => picks[p].iter().copied().collect(),
            Lifting::Treadles { tieup, treadling } => treadling[p]
                .iter()
                .flat_map(|treadle| tieup[usize::from(*treadle) - 1].clone())
                .collect(),
        }
    };
    (0..draft.weft().len())
        .map(|p| {
            let lifted = lifted(p);
            let up = |shafts: &Vec<u16>| shafts.iter().any(|shaft| lifted.contains(shaft));
            let rising = draft.shed() == Shed::Rising;
            let seen = |shafts| if up(shafts) == rising { 'X' } else { '.' };
            draft.threading().iter().map(seen).collect()
        })
        .collect()
}

/// A line as a file may have it, rightly or wrongly.
fn line() -> impl Strategy<Value = String> {
    prop_oneof![
        prop::sample::select(GOOD.lines().map(str::to_owned).collect::<Vec<_>>()),
        "[0-9]{1,2}=[0-9]{1,3}(,[0-9]{1,3}){0,2}",
        "[0-9]{1,4}=[-0-9,.x ]{0,8}",
        "\\[(WARP|WEFT|TIEUP|LIFTPLAN|COLOR TABLE|NOTES|WEFT THICKNESS|PRIVATE X)\\]?",
        "(Threads|Shafts|Treadles|Color|Units|Range|Spacing)=[0-9]{0,3}[,.]?[0-9a-z]{0,3}",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn what_is_written_is_read_again(draft in any_draft()) {
        let text = write(&draft);
        let reading = read("law.wif", text.as_bytes()).unwrap();
        prop_assert_eq!(&reading.draft, &draft);
        prop_assert_eq!(warnings(&reading), [""; 0]);
        prop_assert_eq!(write(&reading.draft), text);
    }

    #[test]
    fn a_draft_of_a_weave_weaves_it(
        weave in prop::collection::vec(prop::collection::vec(any::<bool>(), 7), 1..9),
        ends in 1..50_usize,
        picks in 1..50_usize,
    ) {
        let weave = WeaveMatrix::from_rule(7, weave.len() as u32, |e, p| {
            weave[p as usize][e as usize]
        });
        let threads = |n| vec![Thread::default(); n];
        let drawdown = Draft::of_weave(&weave, threads(ends), threads(picks)).unwrap().drawdown();
        for (e, p) in (0..ends).flat_map(|e| (0..picks).map(move |p| (e, p))) {
            prop_assert_eq!(drawdown.warp_up(e, p), weave.warp_up(e, p));
        }
    }

    #[test]
    fn tie_up_and_treadling_weave_what_their_liftplan_weaves(text in any_file()) {
        let draft = reading(&text).draft;
        prop_assert_eq!(drawn(&draft.drawdown()), by_definition(&draft));
        let plan = draft.clone().with_liftplan();
        prop_assert_eq!(plan.treadles(), 0);
        prop_assert_eq!(drawn(&plan.drawdown()), by_definition(&draft));
        prop_assert_eq!(reading(&write(&plan)).draft, plan);
        prop_assert_eq!(reading(&write(&draft)).draft, draft);
    }

    #[test]
    fn a_sinking_shed_weaves_the_complement(text in any_file()) {
        let (rising, sinking) = if text.contains("=true") {
            (text.clone(), text.replace("=true", "=false"))
        } else {
            (text.replace("=false", "=true"), text)
        };
        let flip = |line: &String| line.replace('X', "x").replace('.', "X").replace('x', ".");
        let rising = drawn(&reading(&rising).draft.drawdown());
        let sinking = drawn(&reading(&sinking).draft.drawdown());
        prop_assert_eq!(rising.iter().map(flip).collect::<Vec<_>>(), sinking);
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = read("any", &bytes);
        let _ = read("any", &[b"[WIF]\n[THREADING]\n1=1\n[LIFTPLAN]\n1=1\n".as_slice(), &bytes].concat());
    }

    #[test]
    fn a_good_draft_with_any_lines_changed_is_read_or_refused(
        changes in prop::collection::vec((any::<prop::sample::Index>(), prop::option::of(line())), 1..8),
    ) {
        let mut lines: Vec<String> = GOOD.lines().map(str::to_owned).collect();
        for (at, line) in changes {
            let at = at.index(lines.len());
            match line {
                Some(line) => lines.insert(at, line),
                None => { lines.remove(at); }
            }
        }
        settled(lines.join("\n").as_bytes())?;
    }

    #[test]
    fn a_good_draft_with_any_bytes_changed_is_read_or_refused(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3_u8), 1..6),
    ) {
        let mut bytes = GOOD.as_bytes().to_vec();
        for (at, byte, how) in changes {
            let at = at.index(bytes.len());
            match how {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ => { bytes.remove(at); }
            }
        }
        settled(&bytes)?;
    }
}

/// Whatever is read, however sloppy, is written in good order: read again it is the same, without a
/// warning.
fn settled(bytes: &[u8]) -> Result<(), TestCaseError> {
    let Ok(reading) = read("any", bytes) else {
        return Ok(());
    };
    prop_assert_eq!(
        drawn(&reading.draft.drawdown()),
        by_definition(&reading.draft)
    );
    prop_assert!(!reading.draft.summary().is_empty());
    let again = read("again", write(&reading.draft).as_bytes()).unwrap();
    prop_assert_eq!(&again.draft, &reading.draft);
    prop_assert_eq!(warnings(&again), [""; 0]);
    Ok(())
}
