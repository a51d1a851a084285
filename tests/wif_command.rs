//! `dyelapse wif`, end to end.

#[path = "common/program.rs"]
mod program;

use std::fs;

use dyelapse::draft::{Draft, bundled, repeat, wif};
use dyelapse::scenario::Experiment;
use program::{contents, dyelapse, folder, said};
use tempfile::TempDir;

fn printed(here: &TempDir, arguments: &[&str]) -> String {
    let output = dyelapse(here).args(arguments).output().unwrap();
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_weave_of_a_scenario_is_written_and_summed_up_again() {
    let here = folder();
    let text = printed(&here, &["wif", "fig10b"]);
    assert_eq!(printed(&here, &["wif", "fig10b", "--out", "twill.wif"]), "");
    assert_eq!(
        fs::read_to_string(here.path().join("twill.wif")).unwrap(),
        text
    );
    let draft = wif::read("twill.wif", text.as_bytes()).unwrap().draft;
    let scenario = Experiment::load("fig10b").unwrap().scenario;
    let weave = scenario.cloth.weave.matrix();
    assert_eq!(repeat(&draft.drawdown()), (weave.ends(), weave.picks()));
    let summary = printed(&here, &["wif", "twill.wif"]);
    assert_eq!(summary, draft.summary());
    assert!(summary.contains(&scenario.title), "{summary}");
    assert!(summary.contains("4 shafts, 4 treadles"), "{summary}");
    assert!(summary.contains("repeat   4 × 4"), "{summary}");
}

#[test]
fn every_bundled_draft_is_listed_and_summed_up() {
    let here = folder();
    let list = printed(&here, &["list"]);
    for draft in bundled() {
        let title = Draft::load(draft.name).unwrap().draft.title().to_owned();
        let listed = |line: &str| line.starts_with(draft.name) && line.ends_with(&title);
        assert!(list.lines().any(listed), "{list}");
        assert!(printed(&here, &["wif", draft.name]).contains(&title));
    }
}

#[test]
fn a_sloppy_draft_is_told_of_and_written_in_good_order() {
    let here = folder();
    let sloppy = "hello\n[wif]\n[Threading]\n1=1\n2=2\n[liftplan]\n1=1\n3=2\nx\n";
    fs::write(here.path().join("sloppy.WIF"), sloppy).unwrap();
    let summary = printed(&here, &["wif", "sloppy.WIF", "--out", "clean.wif"]);
    for told in [
        "sloppy.WIF:1: hello: this comes before [WIF]",
        "sloppy.WIF:9: [LIFTPLAN] x: there is no `=`",
        "[LIFTPLAN] leaves out picks 2;",
    ] {
        assert!(summary.contains(told), "{summary}");
    }
    let clean = printed(&here, &["wif", "clean.wif"]);
    assert_eq!(summary.split("\nread with warnings").next().unwrap(), clean);
}

#[test]
fn what_is_refused_ends_with_2_says_why_and_writes_nothing() {
    let here = folder();
    fs::write(
        here.path().join("bad.wif"),
        "[WIF]\n[THREADING]\n1=1\n2=x\n",
    )
    .unwrap();
    fs::write(here.path().join("there.wif"), "mine").unwrap();
    let before = contents(here.path());
    for (arguments, why) in [
        (
            vec!["bad.wif", "--out", "new.wif"],
            "dyelapse: bad.wif:4: [THREADING] 2=x: a shaft is a whole number",
        ),
        (
            vec!["houndstooth", "--out", "there.wif"],
            "there.wif is there already",
        ),
        (
            vec!["houndstooth", "--out", "no/where.wif"],
            "there is no folder no",
        ),
        (vec!["fig10b", "--out", "."], "is a folder"),
        (
            vec!["nothing.wif"],
            "no file and no bundled draft named `nothing.wif`",
        ),
        (vec!["hounstooth"], "did you mean `houndstooth`?"),
        (vec!["seikaia"], "did you mean `seikaiha`?"),
    ] {
        let (code, text) = said(dyelapse(&here).arg("wif").args(&arguments));
        assert_eq!(code, 2, "{arguments:?}: {text}");
        assert!(text.contains(why), "{arguments:?}: {text}");
        assert_eq!(contents(here.path()), before, "{arguments:?}");
    }
    printed(
        &here,
        &["wif", "houndstooth", "--out", "there.wif", "--force"],
    );
    assert_ne!(contents(here.path()), before);
}
