//! Bundled scenarios and figures are compiled in: a changed or new one makes the program build again.

fn main() {
    println!("cargo::rerun-if-changed=assets/scenarios");
    println!("cargo::rerun-if-changed=assets/figures");
}
