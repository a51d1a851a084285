//! A branch in flower: a line drawing for one bath, dyed on a ground of wax.

use std::f32::consts::{PI, TAU};

use crate::sheet::{Point, Sheet, Tone, path, tapered};

/// Width of the lines that are left of wax inside what is dyed.
const LINE: f32 = 7.0;

/// Draws the design.
pub fn draw() -> Option<Sheet> {
    let mut sheet = Sheet::new(Tone::White)?;
    let stem = bow(
        (-330.0, -470.0),
        (-150.0, -120.0),
        (20.0, -60.0),
        (70.0, 130.0),
    );
    let twig = bow(
        (-196.0, -230.0),
        (-60.0, -300.0),
        (130.0, -260.0),
        (250.0, -190.0),
    );
    let shoot = bow(
        (-210.0, -250.0),
        (-330.0, -90.0),
        (-360.0, 60.0),
        (-330.0, 190.0),
    );
    sheet.fill(&tapered(&stem, 34.0, 16.0), Tone::Ground);
    sheet.fill(&tapered(&twig, 20.0, 10.0), Tone::Ground);
    sheet.fill(&tapered(&shoot, 18.0, 8.0), Tone::Ground);
    // Where on its branch a leaf grows, which way it points, how long it is, and whether it bends
    // the other way.
    let leaves: [(Point, f32, f32, bool); 9] = [
        ((-262.0, -340.0), 0.35, 200.0, true),
        ((-300.0, -400.0), 2.35, 190.0, false),
        ((40.0, -262.0), 1.15, 150.0, false),
        ((70.0, -262.0), -0.75, 170.0, true),
        ((170.0, -236.0), -1.25, 150.0, true),
        ((-352.0, 20.0), 2.7, 150.0, false),
        ((-350.0, 60.0), 0.75, 160.0, true),
        ((-300.0, -130.0), 2.95, 150.0, false),
        ((-60.0, -92.0), 2.25, 170.0, false),
    ];
    for (at, turn, length, mirrored) in leaves {
        sheet.placed(at, turn, |sheet| {
            if mirrored {
                sheet.mirrored(|sheet| blade(sheet, length));
            } else {
                blade(sheet, length);
            }
        });
    }
    bud(&mut sheet, (-330.0, 200.0), 1.45, 1.0);
    bud(&mut sheet, (-410.0, 270.0), 2.1, 0.72);
    sheet.fill(
        &tapered(
            &bow(
                (-346.0, 100.0),
                (-370.0, 160.0),
                (-400.0, 200.0),
                (-408.0, 262.0),
            ),
            8.0,
            6.0,
        ),
        Tone::Ground,
    );
    sheet.placed((300.0, -150.0), 0.5, |sheet| blossom(sheet, 138.0));
    sheet.placed((110.0, 170.0), 0.0, |sheet| blossom(sheet, 232.0));
    butterfly(&mut sheet);
    Some(sheet)
}

/// Points of a cubic curve.
fn bow(a: Point, b: Point, c: Point, d: Point) -> Vec<Point> {
    (0..=48)
        .map(|i| {
            let t = i as f32 / 48.0;
            let u = 1.0 - t;
            let mix = |a: f32, b: f32, c: f32, d: f32| {
                u * u * u * a + 3.0 * u * u * t * b + 3.0 * u * t * t * c + t * t * t * d
            };
            (mix(a.0, b.0, c.0, d.0), mix(a.1, b.1, c.1, d.1))
        })
        .collect()
}

/// A leaf with its veins, from the origin to the right.
fn blade(sheet: &mut Sheet, length: f32) {
    let (l, w) = (length, 0.30 * length);
    let outline = path(|p| {
        p.move_to(0.0, 0.0);
        p.cubic_to(0.15 * l, 0.95 * w, 0.6 * l, 1.05 * w, l, 0.5 * w);
        p.cubic_to(0.8 * l, 0.0, 0.45 * l, -0.85 * w, 0.0, 0.0);
        p.close();
    });
    sheet.fill(&outline, Tone::Ground);
    let rib = bow(
        (0.04 * l, 0.0),
        (0.3 * l, -0.02 * w),
        (0.6 * l, 0.1 * w),
        (0.86 * l, 0.42 * w),
    );
    sheet.fill(&tapered(&rib, LINE, 0.6 * LINE), Tone::White);
    for (i, side) in [(13, 1.0), (21, 1.0), (29, 1.0), (16, -1.0), (24, -1.0)] {
        let (x, y) = rib[i];
        let reach = 0.13 * l * (1.15 - i as f32 / 48.0);
        let vein = path(|p| {
            p.move_to(x, y);
            p.quad_to(
                x + 0.7 * reach,
                y + 0.35 * side * reach,
                x + 1.1 * reach,
                y + side * reach,
            );
        });
        sheet.line(&vein, 0.75 * LINE, Tone::White);
    }
}

/// A petal with a notch, from the origin to the right.
fn notched(sheet: &mut Sheet, reach: f32, wide: f32) {
    let w = 0.5 * wide;
    let outline = path(|p| {
        p.move_to(0.0, 0.0);
        p.cubic_to(
            0.2 * reach,
            0.9 * w,
            0.55 * reach,
            1.45 * w,
            0.88 * reach,
            0.95 * w,
        );
        p.cubic_to(
            1.04 * reach,
            0.62 * w,
            1.06 * reach,
            0.25 * w,
            0.93 * reach,
            0.0,
        );
        p.cubic_to(
            1.06 * reach,
            -0.25 * w,
            1.04 * reach,
            -0.62 * w,
            0.88 * reach,
            -0.95 * w,
        );
        p.cubic_to(0.55 * reach, -1.45 * w, 0.2 * reach, -0.9 * w, 0.0, 0.0);
        p.close();
    });
    sheet.line(&outline, 2.0 * LINE, Tone::White);
    sheet.fill(&outline, Tone::Ground);
    for bend in [-0.5, -0.18, 0.18, 0.5] {
        let tip = reach * (0.84 - 0.1 * f32::abs(bend));
        let vein = path(|p| {
            p.move_to(0.5 * reach, 0.3 * bend * wide);
            p.quad_to(0.7 * reach, 0.75 * bend * wide, tip, 0.8 * bend * wide);
        });
        sheet.line(&vein, 0.7 * LINE, Tone::White);
    }
}

/// A double flower with stamens.
fn blossom(sheet: &mut Sheet, radius: f32) {
    for (count, reach, wide, offset) in [(7, 1.0, 0.88, 0.0), (6, 0.68, 0.66, 0.4)] {
        for i in 0..count {
            let turn = TAU * (i as f32 + offset) / count as f32;
            sheet.placed((0.0, 0.0), turn, |sheet| {
                notched(sheet, reach * radius, wide * radius);
            });
        }
    }
    sheet.dot((0.0, 0.0), 0.24 * radius, Tone::White);
    for i in 0..11 {
        let turn = TAU * i as f32 / 11.0;
        let at = |r: f32| (r * radius * libm::cosf(turn), r * radius * libm::sinf(turn));
        let (from, to) = (at(0.08), at(0.155));
        let thread = path(|p| {
            p.move_to(from.0, from.1);
            p.line_to(to.0, to.1);
        });
        sheet.line(&thread, 0.02 * radius, Tone::Ground);
        sheet.dot(at(0.178), 0.03 * radius, Tone::Ground);
    }
    sheet.dot((0.0, 0.0), 0.06 * radius, Tone::Ground);
}

/// A bud: three closed petals in their sepals.
fn bud(sheet: &mut Sheet, at: Point, turn: f32, size: f32) {
    sheet.placed(at, turn, |sheet| {
        let cup = |length: f32, wide: f32, lean: f32| {
            path(|p| {
                p.move_to(0.0, 0.0);
                p.cubic_to(0.2 * length, wide, 0.7 * length, wide, length, lean);
                p.cubic_to(0.7 * length, -wide, 0.2 * length, -wide, 0.0, 0.0);
                p.close();
            })
        };
        for (tilt, length, wide) in [
            (0.34, 118.0, 40.0),
            (-0.34, 118.0, 40.0),
            (0.0, 132.0, 44.0),
        ] {
            sheet.placed((0.0, 0.0), tilt, |sheet| {
                let petal = cup(size * length, size * wide, 0.0);
                sheet.line(&petal, 2.0 * LINE, Tone::White);
                sheet.fill(&petal, Tone::Ground);
            });
        }
        for tilt in [0.75, -0.75, 0.0] {
            sheet.placed((0.0, 0.0), tilt, |sheet| {
                let sepal = cup(size * 58.0, size * 17.0, 0.0);
                sheet.line(&sepal, 1.5 * LINE, Tone::White);
                sheet.fill(&sepal, Tone::Ground);
            });
        }
    });
}

/// A butterfly that has come to the flowers.
fn butterfly(sheet: &mut Sheet) {
    sheet.placed((356.0, 366.0), -0.5, |sheet| {
        for side in [1.0, -1.0] {
            let wing = |points: [Point; 4]| {
                let [b, c, d, e] = points.map(|(x, y)| (x, side * y));
                path(|p| {
                    p.move_to(0.0, 0.0);
                    p.cubic_to(b.0, b.1, c.0, c.1, d.0, d.1);
                    p.quad_to(e.0, e.1, 0.0, 0.0);
                    p.close();
                })
            };
            let upper = wing([(30.0, 90.0), (110.0, 150.0), (118.0, 96.0), (90.0, 20.0)]);
            let lower = wing([(-20.0, 70.0), (-70.0, 120.0), (-92.0, 70.0), (-80.0, 14.0)]);
            for shape in [&upper, &lower] {
                sheet.line(shape, 2.0 * LINE, Tone::White);
                sheet.fill(shape, Tone::Ground);
            }
            for (x, y, r) in [(78.0, 84.0, 13.0), (50.0, 58.0, 9.0), (-56.0, 66.0, 11.0)] {
                sheet.dot((x, side * y), r, Tone::White);
            }
            let feeler = bow(
                (34.0, 0.0),
                (60.0, side * 4.0),
                (84.0, side * 10.0),
                (96.0, side * 34.0),
            );
            sheet.fill(&tapered(&feeler, 5.0, 4.0), Tone::Ground);
            sheet.dot((97.0, side * 36.0), 5.0, Tone::Ground);
        }
        let body = tapered(
            &bow((-70.0, 0.0), (-30.0, 0.0), (10.0, 0.0), (42.0, 0.0)),
            9.0,
            20.0,
        );
        sheet.line(&body, 1.6 * LINE, Tone::White);
        sheet.fill(&body, Tone::Ground);
        sheet.placed((42.0, 0.0), PI, |sheet| {
            sheet.dot((0.0, 0.0), 11.0, Tone::Ground)
        });
    });
}
