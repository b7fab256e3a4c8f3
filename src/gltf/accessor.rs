//! Reads the numbers of an accessor, whatever their type.

use bevy::prelude::*;
use gltf::{
    Accessor,
    accessor::{DataType, Dimensions, sparse::IndexType},
    buffer::View,
};

/// Numbers of each vertex.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Numbers {
    /// How many there are of each vertex, 1 to 4.
    pub width: usize,
    /// They, and zeros behind them.
    pub values: Vec<Vec4>,
}

/// Reads the numbers of an accessor; normalised ones are from 0 to 1, or -1 to 1. None for matrices, and for what isn't in the
/// file.
pub(super) fn read(accessor: &Accessor, buffers: &[Vec<u8>]) -> Option<Numbers> {
    let width = match accessor.dimensions() {
        Dimensions::Scalar => 1,
        Dimensions::Vec2 => 2,
        Dimensions::Vec3 => 3,
        Dimensions::Vec4 => 4,
        Dimensions::Mat2 | Dimensions::Mat3 | Dimensions::Mat4 => return None,
    };
    let layout = Layout { kind: accessor.data_type(), width, is_normalized: accessor.normalized() };
    let count = accessor.count();
    let mut values = match accessor.view() {
        Some(view) => layout.values(&view, accessor.offset(), count, buffers)?,
        // All are zero, but for those that follow.
        None => vec![Vec4::ZERO; accessor.sparse().map(|_| count)?],
    };
    if let Some(sparse) = accessor.sparse() {
        let kind = match sparse.indices().index_type() {
            IndexType::U8 => DataType::U8,
            IndexType::U16 => DataType::U16,
            IndexType::U32 => DataType::U32,
        };
        let index_layout = Layout { kind, width: 1, is_normalized: false };
        let (indices, others) = (sparse.indices(), sparse.values());
        let indices = index_layout.values(&indices.view(), indices.offset(), sparse.count(), buffers)?;
        let others = layout.values(&others.view(), others.offset(), sparse.count(), buffers)?;
        for (index, other) in indices.into_iter().zip(others) {
            *values.get_mut(index.x as usize)? = other;
        }
    }
    Some(Numbers { width, values })
}

/// How numbers lie in a buffer.
#[derive(Clone, Copy, Debug)]
struct Layout {
    kind: DataType,
    width: usize,
    is_normalized: bool,
}

impl Layout {
    fn values(&self, view: &View, offset: usize, count: usize, buffers: &[Vec<u8>]) -> Option<Vec<Vec4>> {
        let (start, size) = (view.offset(), self.kind.size());
        let bytes = buffers.get(view.buffer().index())?.get(start..start.checked_add(view.length())?)?;
        let stride = view.stride().unwrap_or(self.width * size);
        let value = |i: usize| {
            let mut value = Vec4::ZERO;
            let first = offset.checked_add(i.checked_mul(stride)?)?;
            for part in 0..self.width {
                value[part] = self.number(bytes, first.checked_add(part * size)?)?;
            }
            Some(value)
        };
        (0..count).map(value).collect()
    }

    fn number(&self, bytes: &[u8], at: usize) -> Option<f32> {
        let (number, largest) = match self.kind {
            DataType::I8 => (i8::from_le_bytes(array(bytes, at)?).into(), f32::from(i8::MAX)),
            DataType::U8 => (u8::from_le_bytes(array(bytes, at)?).into(), f32::from(u8::MAX)),
            DataType::I16 => (i16::from_le_bytes(array(bytes, at)?).into(), f32::from(i16::MAX)),
            DataType::U16 => (u16::from_le_bytes(array(bytes, at)?).into(), f32::from(u16::MAX)),
            DataType::U32 => (u32::from_le_bytes(array(bytes, at)?) as f32, u32::MAX as f32),
            DataType::F32 => (f32::from_le_bytes(array(bytes, at)?), 1.0),
        };
        let is_whole = self.kind != DataType::F32;
        Some(if self.is_normalized && is_whole { (number / largest).max(-1.0) } else { number })
    }
}

fn array<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}
