//! Packs bits into bytes, as deflate does.

/// Some bits, with their count in the highest byte.
pub(super) type Entry = u32;

const COUNT_SHIFT: u32 = 24;

pub(super) fn entry(bits: u32, count: u32) -> Entry {
    bits | count << COUNT_SHIFT
}

/// Writes bits, lowest first. The slice must have room for eight bytes more than are written.
pub(super) struct BitWriter<'a> {
    out: &'a mut [u8],
    /// Bytes written, excluding pending bits.
    pub(super) position: usize,
    pending: u64,
    count: u32,
}

impl<'a> BitWriter<'a> {
    pub(super) fn new(out: &'a mut [u8]) -> Self {
        Self { out, position: 0, pending: 0, count: 0 }
    }

    /// Adds an entry. At most 56 bits may be added between two flushes.
    pub(super) fn add_entry(&mut self, entry: Entry) {
        self.pending |= u64::from(entry & ((1 << COUNT_SHIFT) - 1)) << self.count;
        self.count += entry >> COUNT_SHIFT;
    }

    pub(super) fn put_entry(&mut self, entry: Entry) {
        self.add_entry(entry);
        self.flush();
    }

    /// Writes out whole bytes; fewer than eight bits stay pending.
    pub(super) fn flush(&mut self) {
        self.out[self.position..][..8].copy_from_slice(&self.pending.to_le_bytes());
        self.position += (self.count / 8) as usize;
        self.pending >>= self.count & !7;
        self.count &= 7;
    }

    pub(super) fn put(&mut self, value: u64, count: u32) {
        self.pending |= value << self.count;
        self.count += count;
        self.flush();
    }

    /// Pads the last byte with zeros.
    pub(super) fn align(&mut self) {
        self.count = self.count.next_multiple_of(8);
        self.flush();
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) {
        debug_assert_eq!(self.count, 0);
        self.out[self.position..][..bytes.len()].copy_from_slice(bytes);
        self.position += bytes.len();
    }
}
