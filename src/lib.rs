//! Surface reflection by physical and geometrical optics, after S. K. Nayar, K. Ikeuchi and T. Kanade, *Surface
//! Reflection: Physical and Geometrical Perspectives*, CMU-RI-TR-89-7 (1989).
//!
//! [`reflectance`] is the core: it knows the models and nothing of the service around it.
//! Equation numbers in parentheses are the report's. Where the print is wrong the corrected form is the default.
//!
//! | equations | module |
//! | --- | --- |
//! | (1)-(3), (42)-(46), (51)-(56) | [`reflectance::radiometry`] |
//! | (4)-(9), (73) | [`reflectance::surface`] |
//! | (11), (12), (15), (30)-(32), (50) | [`reflectance::waves`] |
//! | (24), (25), (62)-(64) | [`reflectance::fresnel`] |
//! | (28), (34), (36), (37), (59), (60), (76) | [`reflectance::geometry`] |
//! | (35), (47)-(49) | [`reflectance::beckmann_spizzichino`] |
//! | (33), (38), (39) | [`reflectance::scattered_power`] |
//! | (41) | [`reflectance::fresnel_average`] |
//! | (57) | [`reflectance::lambertian`] |
//! | (65) | [`reflectance::shadowing`] |
//! | (58), (61), (66)-(72) | [`reflectance::torrance_sparrow`] |
//! | section 5.1 | [`reflectance::unified`] |
//! | (74), (80) | [`reflectance::image_irradiance`] |
//! | (78), (79) | [`reflectance::roughness`] |

#[cfg(feature = "server")]
pub mod config;
#[cfg(feature = "server")]
pub mod health;
#[cfg(feature = "server")]
pub mod http;
#[cfg(feature = "server")]
pub mod logs;
pub mod reflectance;
