//! Bundled scenarios, figures and drafts are compiled in: a changed or new one makes the program build again.

fn main() {
    println!("cargo::rerun-if-changed=assets/scenarios");
    println!("cargo::rerun-if-changed=assets/drafts");
    println!("cargo::rerun-if-changed=assets/figures");
    println!("cargo::rerun-if-changed=assets/drapes");
}
