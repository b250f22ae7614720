//! From answers to bytes.
