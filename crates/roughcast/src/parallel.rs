//! Distributes work over the threads of the current rayon pool. Without the feature `rayon`, the calling thread
//! processes the items one after the other. Results are in the order of the items in both cases, so they do not depend
//! on the threads.

/// Applies `work` to each item and returns the results.
pub(crate) fn map<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    map_with(items, || (), |(), item| work(item))
}

/// Like [`map`], with scratch state that a thread creates once and reuses for many items.
#[cfg(feature = "rayon")]
pub(crate) fn map_with<T: Send, S, R: Send>(
    items: Vec<T>,
    scratch: impl Fn() -> S + Sync + Send,
    work: impl Fn(&mut S, T) -> R + Sync + Send,
) -> Vec<R> {
    use rayon::prelude::*;
    items.into_par_iter().map_init(scratch, work).collect()
}

/// Like [`map`], with scratch state that is created once and reused for all items.
#[cfg(not(feature = "rayon"))]
pub(crate) fn map_with<T: Send, S, R: Send>(
    items: Vec<T>,
    scratch: impl Fn() -> S + Sync + Send,
    work: impl Fn(&mut S, T) -> R + Sync + Send,
) -> Vec<R> {
    let mut scratch = scratch();
    items.into_iter().map(|item| work(&mut scratch, item)).collect()
}

/// Applies `work` to each item.
pub(crate) fn for_each<T: Send>(items: Vec<T>, work: impl Fn(T) + Sync + Send) {
    map(items, work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_the_items() {
        let doubled = map_with((0..1000).collect(), Vec::new, |seen: &mut Vec<i32>, item| {
            seen.push(item);
            2 * item
        });
        assert_eq!(doubled, (0..1000).map(|item| 2 * item).collect::<Vec<_>>());
    }

    #[test]
    fn pieces_are_written_in_place() {
        let mut numbers = vec![0; 100];
        for_each(numbers.chunks_mut(7).enumerate().collect(), |(index, piece)| piece.fill(index));
        assert!(numbers.iter().enumerate().all(|(place, number)| place / 7 == *number));
    }
}
