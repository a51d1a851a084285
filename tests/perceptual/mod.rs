//! How different two pictures look: the distance of their colours in OKLab (B. Ottosson, "A
//! perceptual color space for image processing", 2020), after a slight blur, as an eye a little way
//! off would see them. A distance of 0.02 is about what can just be told apart side by side.

use dyelapse::texture::Picture;

/// The distance between two pictures over their pixels.
#[derive(Debug, Clone, Copy)]
pub struct Difference {
    /// Of all pixels.
    pub mean: f64,
    /// Only one pixel in a hundred differs by more.
    pub most: f64,
}

/// How different two pictures of one size look.
pub fn difference(one: &Picture, other: &Picture) -> Difference {
    assert_eq!((one.width, one.height), (other.width, other.height));
    let [one, other] = [one, other].map(|picture| blurred(&lab(picture), picture.width));
    let mut distances: Vec<f64> = one
        .iter()
        .zip(&other)
        .map(|(a, b)| {
            (0..3)
                .map(|i| (a[i] - b[i]) * (a[i] - b[i]))
                .sum::<f64>()
                .sqrt()
        })
        .collect();
    distances.sort_by(f64::total_cmp);
    Difference {
        mean: distances.iter().sum::<f64>() / distances.len() as f64,
        most: distances[distances.len() * 99 / 100],
    }
}

fn lab(picture: &Picture) -> Vec<[f64; 3]> {
    let linear = |v: u8| {
        let v = f64::from(v) / 255.0;
        if v <= 0.04045 {
            v / 12.92
        } else {
            libm::pow((v + 0.055) / 1.055, 2.4)
        }
    };
    let times = |m: [[f64; 3]; 3], v: [f64; 3]| m.map(|row| (0..3).map(|i| row[i] * v[i]).sum());
    let pixel = |rgb: &[u8]| {
        let lms: [f64; 3] = times(
            [
                [0.4122214708, 0.5363325363, 0.0514459929],
                [0.2119034982, 0.6806995451, 0.1073969566],
                [0.0883024619, 0.2817188376, 0.6299787005],
            ],
            [linear(rgb[0]), linear(rgb[1]), linear(rgb[2])],
        );
        times(
            [
                [0.2104542553, 0.7936177850, -0.0040720468],
                [1.9779984951, -2.4285922050, 0.4505937099],
                [0.0259040371, 0.7827717662, -0.8086757660],
            ],
            lms.map(libm::cbrt),
        )
    };
    picture.rgb.chunks_exact(3).map(pixel).collect()
}

/// Every pixel with its neighbours: ¼ ½ ¼ both ways; at the edge, what is there counts twice.
fn blurred(lab: &[[f64; 3]], width: usize) -> Vec<[f64; 3]> {
    let height = lab.len() / width;
    let weigh = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        [0, 1, 2].map(|i| 0.25 * a[i] + 0.5 * b[i] + 0.25 * c[i])
    };
    let places = || (0..height).flat_map(|y| (0..width).map(move |x| (y, x)));
    let across: Vec<_> = places()
        .map(|(y, x)| {
            let at = |x: usize| lab[y * width + x];
            weigh(at(x.saturating_sub(1)), at(x), at((x + 1).min(width - 1)))
        })
        .collect();
    places()
        .map(|(y, x)| {
            let at = |y: usize| across[y * width + x];
            weigh(at(y.saturating_sub(1)), at(y), at((y + 1).min(height - 1)))
        })
        .collect()
}
