//! temporary
pub struct Patch { pub mu_from: f64, pub p_scale: f64, pub p_shift: f64, pub q_scale: f64, pub q_shift: f64, pub rows: &'static [&'static [f64]], pub error: f64 }
pub struct Tier { pub truncation: f64, pub variance_from: f64, pub patches: &'static [Patch] }
pub static FULL: Tier = Tier { truncation: 4.5e-16, variance_from: 2.0, patches: &[Patch { mu_from: 4096.0, p_scale: 1.0, p_shift: 0.0, q_scale: 1.0, q_shift: 0.0, error: 4.5e-16, rows: &[
 &[1.0],
 &[-1.0/12., 0.0, 3.0/12., 10.0/12.],
 &[1.0/288., -24.0/288., -30.0/288., -92.0/288., -399.0/288., -420.0/288., 1540.0/288.],
 &[139.0/51840., 540.0/51840., 405.0/51840., -930.0/51840., 12825.0/51840., 129816.0/51840., 278355.0/51840., -810810.0/51840., -2702700.0/51840., 3403400.0/51840.],
]}]};

impl Tier { pub fn is_full(&self) -> bool { self.truncation <= FULL.truncation } }
pub fn within(_tolerance: f64) -> &'static Tier { &FULL }
