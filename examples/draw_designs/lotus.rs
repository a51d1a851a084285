//! A lotus with scrolling vines in a border of tumpal, in the four colours of two waxes and two
//! dyes.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use dyelapse::batik::distance::distance_to;
use dyelapse::pattern::Raster;

use crate::sheet::{OUTLINE, Point, SIDE, Sheet, Tone, VEIN, flower, leaf, path, petal, tapered};

/// From the middle of the design to the edge of its field.
const FIELD: f32 = 396.0;

/// Draws the design.
pub fn draw() -> Option<Sheet> {
    let mut sheet = Sheet::new(Tone::Ground)?;
    for quarter in 0..4 {
        sheet.placed((0.0, 0.0), quarter as f32 * FRAC_PI_2, |sheet| {
            border(sheet);
            spear(sheet);
            vine(sheet);
            // The other vine of the quarter, mirrored on the diagonal.
            sheet.placed((0.0, 0.0), FRAC_PI_2, |sheet| sheet.mirrored(vine));
            corner(sheet);
        });
    }
    lotus(&mut sheet);
    isen(&mut sheet);
    Some(sheet)
}

/// The lotus in the middle: four rings of petals, the outermost first.
fn lotus(sheet: &mut Sheet) {
    let ring = |sheet: &mut Sheet, reach: f32, count: u32, wide: f32, offset: f32, tone: Tone| {
        for i in 0..count {
            let turn = TAU * (i as f32 + offset) / count as f32;
            sheet.placed((0.0, 0.0), turn, |sheet| {
                sheet.shape(&petal(reach, wide), tone);
                // Veins fan out from the base of the petal towards its tip.
                for bend in [-0.22_f32, 0.0, 0.22] {
                    let vein = path(|p| {
                        p.move_to(0.62 * reach, 0.42 * bend * wide);
                        let tip = reach * (0.86 - 0.25 * bend.abs());
                        p.quad_to(0.74 * reach, 1.5 * bend * wide, tip, bend * wide);
                    });
                    sheet.line(&vein, VEIN, Tone::White);
                }
            });
        }
    };
    ring(sheet, 206.0, 16, 64.0, 0.5, Tone::Second);
    ring(sheet, 168.0, 12, 70.0, 0.0, Tone::First);
    ring(sheet, 122.0, 8, 74.0, 0.5, Tone::Second);
    sheet.dot((0.0, 0.0), 58.0 + OUTLINE, Tone::White);
    sheet.dot((0.0, 0.0), 58.0, Tone::First);
    // Seeds: one, six, twelve.
    for (count, radius) in [(1, 0.0), (6, 21.0), (12, 42.0)] {
        for i in 0..count {
            let turn = TAU * (i as f32 + 0.25) / count as f32;
            let at = (radius * libm::cosf(turn), radius * libm::sinf(turn));
            sheet.dot(at, 6.0, Tone::White);
        }
    }
}

/// A vine that leaves the lotus along the diagonal and rolls up beside it, with leaves and a flower.
fn vine(sheet: &mut Sheet) {
    let (cx, cy, turns) = (288.0, 122.0, 1.2 * TAU);
    let begin = 0.75 * PI;
    let at = |t: f32| {
        let r = 84.0 - 58.0 * t;
        let angle = begin - turns * t;
        (cx + r * libm::cosf(angle), cy + r * libm::sinf(angle))
    };
    // From under the lotus in a bow into the spiral.
    let (from, bow, to) = ((104.0, 104.0), (168.0, 120.0), at(0.0));
    let mut points: Vec<Point> = (0..16)
        .map(|i| {
            let t = i as f32 / 16.0;
            let mix = |a: f32, b: f32, c: f32| {
                (1.0 - t) * (1.0 - t) * a + 2.0 * t * (1.0 - t) * b + t * t * c
            };
            (mix(from.0, bow.0, to.0), mix(from.1, bow.1, to.1))
        })
        .collect();
    points.extend((0..=120).map(|i| at(i as f32 / 120.0)));
    let leaves = [
        (0.02, 0.9, 50.0, Tone::Second),
        (0.10, 0.75, 56.0, Tone::First),
        (0.19, 0.7, 54.0, Tone::Second),
        (0.28, 0.5, 40.0, Tone::First),
        (0.36, 0.45, 36.0, Tone::Second),
        (0.44, 0.5, 30.0, Tone::First),
    ];
    for (t, out, length, tone) in leaves {
        let (from, to) = (at(t), at(t + 0.01));
        let along = libm::atan2f(to.1 - from.1, to.0 - from.0);
        // The vine turns to the right: its outside is to the left.
        sheet.placed(from, along + out, |sheet| leaf(sheet, length, tone));
    }
    sheet.shape(&tapered(&points, 12.0, 5.0), Tone::First);
    sheet.placed((cx, cy), 0.3, |sheet| flower(sheet, 38.0, 6, Tone::Second));
}

/// A bud in the corner of the field, on the diagonal.
fn corner(sheet: &mut Sheet) {
    sheet.placed((238.0, 238.0), 0.25 * PI, |sheet| {
        for side in [1.0, -1.0] {
            for (turn, length, tone) in [(1.25, 84.0, Tone::First), (0.74, 116.0, Tone::Second)] {
                sheet.placed((34.0, 0.0), side * turn, |sheet| {
                    if side > 0.0 {
                        sheet.mirrored(|sheet| leaf(sheet, length, tone));
                    } else {
                        leaf(sheet, length, tone);
                    }
                });
            }
        }
        sheet.placed((30.0, 0.0), 0.0, |sheet| {
            sheet.shape(&petal(152.0, 78.0), Tone::First);
            sheet.shape(&petal(104.0, 42.0), Tone::Second);
            for i in 0..4 {
                sheet.dot(
                    (112.0 + 9.0 * i as f32, 0.0),
                    4.8 - 0.6 * i as f32,
                    Tone::White,
                );
            }
        });
        sheet.placed((20.0, 0.0), 0.0, |sheet| {
            flower(sheet, 42.0, 7, Tone::Second)
        });
    });
}

/// A spear between two vines.
fn spear(sheet: &mut Sheet) {
    sheet.placed((216.0, 0.0), 0.0, |sheet| {
        sheet.shape(&petal(164.0, 38.0), Tone::Second);
        let rib = path(|p| {
            p.move_to(26.0, 0.0);
            p.line_to(132.0, 0.0);
        });
        sheet.line(&rib, VEIN, Tone::White);
        for i in 0..4 {
            let x = 36.0 + 22.0 * i as f32;
            for side in [1.0, -1.0] {
                sheet.dot((x + 12.0, side * 10.0), 3.4, Tone::White);
            }
        }
    });
}

/// One side of the border: a row of tumpal, the triangles of Javanese borders, that point inwards.
fn border(sheet: &mut Sheet) {
    let (inner, outer) = (FIELD + 14.0, 492.0);
    let count = 9;
    let step = 2.0 * FIELD / count as f32;
    for i in 0..count {
        let y = -FIELD + step * (i as f32 + 0.5);
        sheet.placed((outer, y), 0.0, |sheet| {
            let (h, w) = (outer - inner - 6.0, 0.5 * step - OUTLINE);
            let triangle = path(|p| {
                p.move_to(0.0, w);
                p.quad_to(-0.35 * h, 0.55 * w, -h, 0.0);
                p.quad_to(-0.35 * h, -0.55 * w, 0.0, -w);
                p.close();
            });
            sheet.shape(
                &triangle,
                if i % 2 == 0 {
                    Tone::Second
                } else {
                    Tone::First
                },
            );
            for turn in [-0.62, 0.0, 0.62] {
                sheet.placed((-3.0, 0.0), PI + turn, |sheet| {
                    let reach = if turn == 0.0 { 44.0 } else { 27.0 };
                    sheet.fill(&petal(reach, 13.0), Tone::White);
                });
            }
            sheet.dot((-0.72 * h, 0.0), 3.4, Tone::White);
        });
        let between = y + 0.5 * step;
        if i + 1 < count {
            for (dx, dy, r) in [
                (0.0, 0.0, 5.5),
                (17.0, 0.0, 4.2),
                (7.0, 11.0, 4.0),
                (7.0, -11.0, 4.0),
            ] {
                sheet.dot((inner + 20.0 + dx, between + dy), r, Tone::White);
            }
        }
    }
    let line = |x: f32, y: f32| {
        path(|p| {
            p.move_to(x, -y);
            p.line_to(x, y);
        })
    };
    sheet.line(&line(FIELD, FIELD), 8.0, Tone::White);
    sheet.line(&line(outer + 10.0, outer + 10.0), 9.0, Tone::White);
    let beads = 40;
    for i in 0..beads {
        let y = -FIELD + 2.0 * FIELD * (i as f32 + 0.5) / beads as f32;
        sheet.dot((FIELD + 11.5, y), 3.6, Tone::White);
    }
    sheet.placed(
        (0.5 * (inner + outer) - 2.0, 0.5 * (inner + outer) - 2.0),
        0.25 * PI,
        |sheet| {
            flower(sheet, 42.0, 8, Tone::First);
        },
    );
}

/// Fills what is left of the field with dots, as isen do: near nothing, and near each other.
fn isen(sheet: &mut Sheet) {
    let [first, second] = sheet.wax();
    let most = first
        .iter()
        .zip(&second)
        .map(|(a, b)| f32::from(*a.max(b)) / 255.0);
    let side = SIDE as usize;
    let waxed = Raster {
        nx: side,
        ny: side,
        values: most.collect(),
    };
    let far = distance_to(&waxed, 0.5);
    let mut dots: Vec<(f32, f32)> = Vec::new();
    // Places in a hexagonal order, one quadrant after the other by symmetry.
    let step = 17.0;
    for row in 0..64 {
        for column in 0..64 {
            let x = (column as f32 + if row % 2 == 0 { 0.0 } else { 0.5 }) * step;
            let y = row as f32 * step * 0.866;
            if x > FIELD - 10.0 || y > FIELD - 10.0 {
                continue;
            }
            let at = |x: f32, y: f32| {
                let (px, py) = ((512.0 + x) as usize, (512.0 - y) as usize);
                far[py.min(side - 1) * side + px.min(side - 1)]
            };
            if at(x, y) > 13.0 && at(y, x) > 13.0 {
                dots.push((x, y));
            }
        }
    }
    for (x, y) in dots {
        for (sx, sy) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
            sheet.dot((sx * x, sy * y), 4.4, Tone::White);
        }
    }
}
