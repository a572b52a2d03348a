//! Pipelines by their source. Levels that are made in the same way share a pipeline.

/// Pipelines made so far.
pub(super) struct Pipelines<P> {
    made: Vec<(String, P)>,
}

impl<P: Clone> Pipelines<P> {
    pub fn new() -> Self {
        Self { made: Vec::new() }
    }

    /// Returns the pipeline for this shader source, creating it if needed. The source alone identifies a pipeline.
    pub fn of(&mut self, source: String, make: impl FnOnce(&str) -> P) -> P {
        if let Some((_, pipeline)) = self.made.iter().find(|(known, _)| *known == source) {
            return pipeline.clone();
        }
        let pipeline = make(&source);
        self.made.push((source, pipeline.clone()));
        pipeline
    }
}
