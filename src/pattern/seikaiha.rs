//! Seikaiha, "waves of the blue sea": overlapping fans of concentric rings (paper D Fig 11).

/// Paste (1) or open arc (0) at a point, for fans of `radius` cells.
///
/// Fans stand in rows half a radius apart, every other row moved by a radius; a lower row covers
/// the one above it, so a point belongs to the lowest fan that reaches it. Each fan is cut into
/// `arcs` rings; the outer share `open` of every ring is left open.
pub(super) fn paste(x: f64, y: f64, radius: f64, arcs: f64, open: f64) -> f32 {
    let lowest = ((y + radius) / (radius / 2.0)).floor();
    let distance = (0..5)
        .map(|up| lowest - f64::from(up))
        .map(|row| {
            let shift = if row.rem_euclid(2.0) == 1.0 {
                radius
            } else {
                0.0
            };
            let dy = y - row * radius / 2.0;
            // The nearest fan of this row, measured from its middle.
            let dx = (x - shift + radius).rem_euclid(2.0 * radius) - radius;
            (dx * dx + dy * dy).sqrt()
        })
        .find(|distance| *distance < radius)
        // Rows are so close that some fan always reaches; rounding could only leave its very edge.
        .unwrap_or(radius);
    let within_ring = (distance / radius * arcs).rem_euclid(1.0);
    if within_ring > 1.0 - open { 0.0 } else { 1.0 }
}
