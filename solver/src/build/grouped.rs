//! Items by a number, such as triangles by the particle that they are at, all in one list.

use core::ops::Range;

/// Items in groups that are numbered from 0.
#[derive(Clone, Debug, Default)]
pub(super) struct Grouped<T> {
    /// The groups, one behind the other.
    items: Vec<T>,
    /// Where each group begins, and behind the last one the end.
    starts: Vec<u32>,
}

impl<T: Copy> Grouped<T> {
    /// Puts items, each with the number of its group, into `count` groups. Within a group they keep their order.
    pub fn new(count: usize, items: impl Iterator<Item = (u32, T)> + Clone) -> Self {
        let mut starts = vec![0; count + 1];
        for (group, _) in items.clone() {
            starts[group as usize + 1] += 1;
        }
        for group in 0..count {
            starts[group + 1] += starts[group];
        }
        let mut next = starts.clone();
        let mut grouped: Vec<T> = items.clone().map(|(_, item)| item).collect();
        for (group, item) in items {
            let place = &mut next[group as usize];
            grouped[*place as usize] = item;
            *place += 1;
        }
        Self { items: grouped, starts }
    }

    /// The items of a group.
    pub fn of(&self, group: u32) -> &[T] {
        &self.items[self.range(group)]
    }

    /// The places of a group's items in [`items`](Self::items).
    pub fn range(&self, group: u32) -> Range<usize> {
        let group = group as usize;
        self.starts[group] as usize..self.starts[group + 1] as usize
    }

    /// All items, group after group.
    pub fn items(&self) -> &[T] {
        &self.items
    }

    /// The groups, to be sorted.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut [T]> {
        let mut left = self.items.as_mut_slice();
        self.starts
            .array_windows()
            .map(move |[start, end]| left.split_off_mut(..(end - start) as usize).unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_stand_in_their_groups_in_their_order() {
        let grouped = Grouped::new(4, [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd'), (2, 'e')].into_iter());
        let groups = [0, 1, 2, 3].map(|group| grouped.of(group).iter().collect::<String>());
        assert_eq!(groups, ["b", "", "ace", "d"]);
        assert_eq!(grouped.items(), ['b', 'a', 'c', 'e', 'd']);
    }
}
