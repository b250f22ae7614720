//! What a scene requires.
