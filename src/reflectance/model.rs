//! The models and the reflection components they are made of (section 5.1).

/// Which of the report's models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Model {
    /// Specular lobe + specular spike, (47).
    BeckmannSpizzichino,
    /// Diffuse lobe + facet lobe, (72).
    TorranceSparrow,
    /// Diffuse lobe, (57).
    Lambertian,
    /// Lambertian diffuse lobe + Torrance-Sparrow specular lobe + Beckmann-Spizzichino spike, section 5.1.
    Unified,
}

impl Model {
    /// Every model.
    pub const ALL: [Self; 4] =
        [Self::BeckmannSpizzichino, Self::TorranceSparrow, Self::Lambertian, Self::Unified];

    /// The components the model is made of, in the order in which they are answered.
    pub const fn components(self) -> &'static [Component] {
        use Component::{DiffuseLobe, SpecularLobe, SpecularSpike};
        match self {
            Self::BeckmannSpizzichino => &[SpecularLobe, SpecularSpike],
            Self::TorranceSparrow => &[DiffuseLobe, SpecularLobe],
            Self::Lambertian => &[DiffuseLobe],
            Self::Unified => &[DiffuseLobe, SpecularLobe, SpecularSpike],
        }
    }

    /// The name in requests and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::BeckmannSpizzichino => "beckmann_spizzichino",
            Self::TorranceSparrow => "torrance_sparrow",
            Self::Lambertian => "lambertian",
            Self::Unified => "unified",
        }
    }
}

/// A primary reflection component, section 5.1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Component {
    /// (57)
    DiffuseLobe,
    /// The second term of (47), or (70).
    SpecularLobe,
    /// The first term of (47).
    SpecularSpike,
}

impl Component {
    /// Every component.
    pub const ALL: [Self; 3] = [Self::DiffuseLobe, Self::SpecularLobe, Self::SpecularSpike];

    /// The name in requests and answers.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DiffuseLobe => "diffuse_lobe",
            Self::SpecularLobe => "specular_lobe",
            Self::SpecularSpike => "specular_spike",
        }
    }

    /// The name of its decimal logarithm in answers.
    pub const fn log10_name(self) -> &'static str {
        match self {
            Self::DiffuseLobe => "log10_diffuse_lobe",
            Self::SpecularLobe => "log10_specular_lobe",
            Self::SpecularSpike => "log10_specular_spike",
        }
    }

    pub(super) const fn index(self) -> usize {
        self as usize
    }
}
