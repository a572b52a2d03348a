//! The targets of a frame.

/// Whether a drawing is the only one in its target, or one of several.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The target is cleared to the background. Nothing else is drawn into it with these depths.
    #[default]
    Only,
    /// The target is cleared to the background. Its depths are kept for later drawings.
    First,
    /// Earlier contents stay, except where this drawing hides them.
    Next,
}

/// A rectangle of a target, in pixels from its top left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Number of columns to its left.
    pub x: u32,
    /// Number of rows above it.
    pub y: u32,
    /// Its width.
    pub width: u32,
    /// Its height.
    pub height: u32,
}

/// The texture views that a frame is drawn into. All must have the same size and the formats of the renderer's target;
/// otherwise wgpu refuses them.
#[derive(Clone, Copy, Debug)]
pub struct Views<'a> {
    /// The colour target.
    pub colour: &'a wgpu::TextureView,
    /// The second target of [`RenderTarget::Parts`](super::RenderTarget::Parts); None for other targets.
    pub specular: Option<&'a wgpu::TextureView>,
    /// The depth target, of [`DEPTH_FORMAT`](super::DEPTH_FORMAT).
    pub depth: &'a wgpu::TextureView,
    /// The part of the target that is drawn into; None for all of it. Clearing always clears the whole target.
    pub part: Option<Part>,
    /// Whether the target is cleared, and whether its depths are kept.
    pub order: Order,
}

impl<'a> Views<'a> {
    /// Views of a whole colour target, for a single drawing.
    pub fn new(colour: &'a wgpu::TextureView, depth: &'a wgpu::TextureView) -> Self {
        Self { colour, specular: None, depth, part: None, order: Order::Only }
    }

    /// The colour targets, with the radiance that they are cleared to. Coverage is cleared to zero.
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
