//! What nothing else beats.

/// Indices of the pairs that no other pair beats in both values (less is better), by increasing first value. What is not finite
/// takes no part; of equals the first stays.
pub fn pareto(pairs: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..pairs.len()).filter(|&i| pairs[i].iter().all(|v| v.is_finite())).collect();
    order.sort_by(|&a, &b| pairs[a][0].total_cmp(&pairs[b][0]).then(pairs[a][1].total_cmp(&pairs[b][1])));
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let better = pairs[i][1] < least;
        least = least.min(pairs[i][1]);
        better
    });
    order
}
