//! Files in and out: images, and textures with their levels.
