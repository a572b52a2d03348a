//! What a frame is drawn into.

/// Whether a drawing is alone in its target, or one of several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The target is cleared to the background, and nothing else is drawn into it with these depths.
    #[default]
    Only,
    /// The target is cleared to the background, and its depths are kept for later drawings.
    First,
    /// Earlier contents stay, except where they are hidden.
    Next,
}

/// A rectangle of a target, in pixels from its top left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Columns to its left.
    pub x: u32,
    /// Rows above it.
    pub y: u32,
    /// Its columns.
    pub width: u32,
    /// Its rows.
    pub height: u32,
}

/// The views of textures that a frame is drawn into, all of one size and of the formats of the renderer's target: wgpu
/// refuses others.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a> {
    /// The colour target.
    pub colour: &'a wgpu::TextureView,
    /// The second target of [`RenderTarget::Parts`](super::RenderTarget::Parts); None for other targets.
    pub specular: Option<&'a wgpu::TextureView>,
    /// Of [`DEPTH_FORMAT`](super::DEPTH_FORMAT).
    pub depth: &'a wgpu::TextureView,
    /// The part that is drawn into; None for all of it. Clearing clears the whole target.
    pub part: Option<Part>,
    /// Whether the target is cleared, and its depths kept.
    pub order: Order,
}

impl<'a> Views<'a> {
    /// All of a colour target, for one drawing alone.
    pub fn new(colour: &'a wgpu::TextureView, depth: &'a wgpu::TextureView) -> Self {
        Self { colour, specular: None, depth, part: None, order: Order::Only }
    }

    /// The colour targets, with the radiance to which they are cleared. Coverage is cleared to zero.
    pub(super) fn colour_attachments(
        &self,
        background: [f32; 3],
    ) -> Vec<Option<wgpu::RenderPassColorAttachment<'a>>> {
        let [r, g, b] = background.map(f64::from);
        let target = |view, clear| {
            let load = match self.order {
                Order::Only | Order::First => wgpu::LoadOp::Clear(clear),
                Order::Next => wgpu::LoadOp::Load,
            };
            let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        };
        let mut colours = vec![target(self.colour, wgpu::Color { r, g, b, a: 0.0 })];
        colours.extend(self.specular.map(|view| target(view, wgpu::Color::TRANSPARENT)));
        colours
    }

    pub(super) fn depth_attachment(&self) -> wgpu::RenderPassDepthStencilAttachment<'a> {
        let (load, store) = match self.order {
            Order::Only => (wgpu::LoadOp::Clear(0.0), wgpu::StoreOp::Discard),
            Order::First => (wgpu::LoadOp::Clear(0.0), wgpu::StoreOp::Store),
            Order::Next => (wgpu::LoadOp::Load, wgpu::StoreOp::Store),
        };
        let depth_ops = Some(wgpu::Operations { load, store });
        wgpu::RenderPassDepthStencilAttachment { view: self.depth, depth_ops, stencil_ops: None }
    }
}
