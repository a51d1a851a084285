//! The force laws of single links between two particles (paper C eqs 1–4, after Choi and Ko,
//! *Stable but Responsive Cloth*, SIGGRAPH 2002; model section 8).
//!
//! r is the distance of the two ends, L the natural length, both in metres. Every law gives the
//! pull f in newtons: the force on the first end is f·n, n pointing to the second; a negative pull
//! pushes apart.
//!
//! **Type 1**, against stretch: f = k(r − L) for r > L, else 0. **Type 2**, against bending: the
//! cloth between the ends keeps its length L and bends into an arc whose chord is r. With
//! u = κL/2, sinc u = sin u / u = r/L, the energy is E = ½·k_b·κ²·L = (2k_b/L)·u², so
//!
//! f_b = dE/dr = (2k_b/L²) / S′(s),  df_b/dr = −(2k_b/L³)·S″(s)/S′(s)³,  s = u², S(s) = sinc √s.
//!
//! This is paper C's f_b = k_b·κ²/(cos u − sinc u), as S′(s) = (cos u − sinc u)/(2s). In s there is no
//! special case as r → L, where S′ = −1/6 and S″ = 1/60 give −12k_b/L² and 7.2k_b/L³. Before it
//! buckles the link is a spring: f_b* = max(f_b, c_b(r − L)).

/// An arc of cloth seen from its two ends, in s = u² (see the [module](self)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// s = (κL/2)².
    pub s: f64,
    /// S′(s).
    pub first: f64,
    /// S″(s).
    pub second: f64,
}

/// (−1)ᵏ/(2k+1)!: S(s) = Σ `SERIES[k]`·sᵏ. At s = π², the furthest that is asked for, the first term
/// left out is below 10⁻¹³.
const SERIES: [f64; 14] = series();

const fn series() -> [f64; 14] {
    let mut terms = [1.0; 14];
    let mut k = 1;
    while k < 14 {
        terms[k] = -terms[k - 1] / ((2 * k) as f64 * (2 * k + 1) as f64);
        k += 1;
    }
    terms
}

/// s/6z as a polynomial of z, to 3·10⁻⁶ (interpolated at Chebyshev's points of 0 to 1).
const START: [f64; 11] = [
    1.000000920,
    0.299778064,
    0.145877612,
    -0.057913201,
    1.053715912,
    -4.381057774,
    11.710607904,
    -19.170571846,
    19.065307825,
    -10.532599940,
    2.511784464,
];

impl Arc {
    /// The arc whose chord is shorter than itself by the share `z` = 1 − r/L, 0 to 1.
    ///
    /// A Newton step from a polynomial is off by 5·10⁻¹² of s at most. (That of model section 8 would need
    /// three.)
    #[inline(always)]
    pub fn of_shortening(z: f64) -> Self {
        let mut share = START[10];
        for k in (0..10).rev() {
            share = share * z + START[k];
        }
        let mut s = 6.0 * z * share;
        // S − 1 = s·T(s): 1 is never added, so what is left is as exact as z however small.
        let (mut value, mut first) = (SERIES[13], 0.0);
        for k in (1..13).rev() {
            first = first * s + value;
            value = value * s + SERIES[k];
        }
        s -= (s * value + z) / (value + s * first);
        let (mut value, mut first, mut second) = (SERIES[13], 0.0, 0.0);
        for k in (1..13).rev() {
            second = second * s + first;
            first = first * s + value;
            value = value * s + SERIES[k];
        }
        Arc {
            s,
            first: value + s * first,
            second: 2.0 * (first + s * second),
        }
    }
}

/// A pull and how it changes with the distance.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pull {
    /// f, N; negative pushes apart.
    pub force: f64,
    /// df/dr, N/m.
    pub stiffness: f64,
}

/// A type 1 link: a spring of stiffness `k` (N/m) that cannot push.
#[inline(always)]
pub fn stretch(r: f64, length: f64, k: f64) -> Pull {
    let on = if r > length { k } else { 0.0 };
    Pull {
        force: on * (r - length),
        stiffness: on,
    }
}

/// A type 1 link as an implicit step sees it, which will about end at the distance `then`.
///
/// One that is slack but comes taut within the step acts already: linear about r < L it would not be
/// there at all, and whatever moves fast would overshoot it by the length of a step.
#[inline(always)]
pub fn stretch_ahead(r: f64, then: f64, length: f64, k: f64) -> Pull {
    let on = if r.max(then) > length { k } else { 0.0 };
    Pull {
        force: on * (r - length),
        stiffness: on,
    }
}

/// A link of Lander's model: a spring of stiffness `k` (N/m) both ways.
#[inline(always)]
pub fn spring(r: f64, length: f64, k: f64) -> Pull {
    Pull {
        force: k * (r - length),
        stiffness: k,
    }
}

/// A type 2 link: flexural rigidity `k_b` (N·m²), and `c_b` (N/m) before it buckles.
#[inline(always)]
pub fn bend(r: f64, length: f64, k_b: f64, c_b: f64) -> Pull {
    let z = (1.0 - r / length).clamp(0.0, 1.0);
    let arc = Arc::of_shortening(z);
    let per_length = 1.0 / length;
    let scale = 2.0 * k_b * per_length * per_length;
    let bent = scale / arc.first;
    let straight = c_b * (r - length);
    let cubed = arc.first * arc.first * arc.first;
    let stiffness = if bent > straight {
        -scale * per_length * arc.second / cubed
    } else {
        c_b
    };
    let force = if bent > straight { bent } else { straight };
    if r < length {
        Pull { force, stiffness }
    } else {
        Pull::default()
    }
}

/// The energy of a type 1 link, J.
pub fn stretch_energy(r: f64, length: f64, k: f64) -> f64 {
    let longer = (r - length).max(0.0);
    0.5 * k * longer * longer
}

/// The energy of a link of Lander's model, J.
pub fn spring_energy(r: f64, length: f64, k: f64) -> f64 {
    0.5 * k * (r - length) * (r - length)
}

/// The energy of a type 2 link, J: that of an arc, and before it buckles, that of a spring.
pub fn bend_energy(r: f64, length: f64, k_b: f64, c_b: f64) -> f64 {
    if r >= length || k_b == 0.0 {
        return 0.0;
    }
    let arc = |r: f64| Arc::of_shortening((1.0 - r / length).clamp(0.0, 1.0));
    let of_arc = |r: f64| 2.0 * k_b / length * arc(r).s;
    let of_spring = |r: f64| 0.5 * c_b * (r - length) * (r - length);
    // Where the spring gives way to the arc: c_b(r − L) = f_b(r). f_b rises with r and changes
    // little, so halving the interval is enough.
    let gives_way = |r: f64| c_b * (r - length) < 2.0 * k_b / (length * length) / arc(r).first;
    if !gives_way(r) {
        return of_spring(r);
    }
    let (mut bent, mut straight) = (r, length);
    for _ in 0..100 {
        let middle = 0.5 * (bent + straight);
        if gives_way(middle) {
            bent = middle;
        } else {
            straight = middle;
        }
    }
    of_spring(straight) + of_arc(r) - of_arc(straight)
}
