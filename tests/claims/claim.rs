//! A statement of the report, what it is worth here, and the numbers that say so.

/// What becomes of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Holds,
    Partly,
    Fails,
}

impl Verdict {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Partly => "partly",
            Self::Fails => "fails",
        }
    }
}

/// A number expected and measured.
pub(crate) struct Measured {
    pub(crate) what: String,
    pub(crate) expected: String,
    pub(crate) found: String,
    fits: bool,
}

/// One statement.
pub(crate) struct Claim {
    pub(crate) place: &'static str,
    pub(crate) says: &'static str,
    pub(crate) expected: Verdict,
    pub(crate) remark: &'static str,
    pub(crate) measured: Vec<Measured>,
    cases: Vec<(String, bool)>,
}

/// A number as quoted: its value, the size of its last digit, and how to write one digit more.
struct Quoted {
    value: f64,
    last_digit: f64,
    decimals: usize,
    scientific: bool,
}

impl Quoted {
    fn parse(text: &str) -> Self {
        let (mantissa, exponent) =
            text.split_once('e').map_or((text, 0), |(m, e)| (m, e.parse().expect("exponent")));
        let decimals = mantissa.split_once('.').map_or(0, |(_, digits)| digits.len());
        let places = i32::try_from(decimals).expect("few decimals");
        Self {
            value: text.parse().expect("a number"),
            last_digit: 10f64.powi(exponent - places),
            decimals,
            scientific: text.contains('e'),
        }
    }

    fn write(&self, value: f64) -> String {
        let decimals = self.decimals + 1;
        if self.scientific { format!("{value:.decimals$e}") } else { format!("{value:.decimals$}") }
    }
}

impl Claim {
    /// What the report says and where, and what is expected to become of it.
    pub(crate) const fn new(
        place: &'static str,
        says: &'static str,
        expected: Verdict,
        remark: &'static str,
    ) -> Self {
        Self { place, says, expected, remark, measured: Vec::new(), cases: Vec::new() }
    }

    /// A number that has to agree with the quoted one in every digit quoted: to half of the last.
    pub(crate) fn number(&mut self, what: impl Into<String>, quoted: &str, value: f64) {
        self.number_within(what, quoted, value, 0.5);
    }

    /// The same to so many units of the last digit quoted; the caller says why it is not one half.
    pub(crate) fn number_within(&mut self, what: impl Into<String>, quoted: &str, value: f64, units: f64) {
        let number = Quoted::parse(quoted);
        // The measured number's own error is far below 1e-6 of a quoted digit.
        let fits = (value - number.value).abs() <= (units + 1e-6) * number.last_digit;
        self.push(what, quoted.to_owned(), number.write(value), fits);
    }

    /// A number that must not exceed the quoted one, rounded as quoted.
    pub(crate) fn at_most(&mut self, what: impl Into<String>, quoted: &str, value: f64) {
        let number = Quoted::parse(quoted);
        let fits = value <= number.value + 0.5 * number.last_digit;
        self.push(what, format!("≤ {quoted}"), number.write(value), fits);
    }

    /// A fact that is no number.
    pub(crate) fn fact(&mut self, what: impl Into<String>, expected: &str, found: impl Into<String>) {
        let found = found.into();
        let fits = found == expected;
        self.push(what, expected.to_owned(), found, fits);
    }

    fn push(&mut self, what: impl Into<String>, expected: String, found: String, fits: bool) {
        self.measured.push(Measured { what: what.into(), expected, found, fits });
    }

    /// An instance of the statement, and whether it is true. The verdict follows from all of them.
    pub(crate) fn case(&mut self, instance: impl Into<String>, holds: bool) {
        self.cases.push((instance.into(), holds));
    }

    /// What becomes of the statement by its instances.
    pub(crate) fn verdict(&self) -> Verdict {
        assert!(!self.cases.is_empty(), "{}: no instance", self.says);
        match self.cases.iter().filter(|(_, holds)| *holds).count() {
            0 => Verdict::Fails,
            n if n == self.cases.len() => Verdict::Holds,
            _ => Verdict::Partly,
        }
    }

    /// Instances in which the statement is true, or those in which it is not.
    pub(crate) fn instances(&self, true_ones: bool) -> String {
        let names = self.cases.iter().filter(|(_, holds)| *holds == true_ones).map(|(name, _)| name.as_str());
        names.collect::<Vec<_>>().join("; ")
    }

    /// Every number and the verdict are as expected.
    pub(crate) fn check(&self) {
        let misfits = self.measured.iter().filter(|m| !m.fits);
        let mut wrong: Vec<_> =
            misfits.map(|m| format!("{}: expected {}, measured {}", m.what, m.expected, m.found)).collect();
        if self.verdict() != self.expected {
            wrong.push(format!(
                "expected that it {}, but true: [{}], false: [{}]",
                self.expected.name(),
                self.instances(true),
                self.instances(false)
            ));
        }
        assert!(wrong.is_empty(), "{}\n  {}", self.says, wrong.join("\n  "));
    }
}

/// Makes a test of every statement, and a list of them all for the page.
macro_rules! statements {
    ($($name:ident;)*) => {
        pub(crate) fn all() -> Vec<crate::claim::Claim> {
            vec![$($name()),*]
        }

        mod checked {
            $(
                #[test]
                fn $name() {
                    super::$name().check();
                }
            )*
        }
    };
}
pub(crate) use statements;

#[test]
fn a_number_fits_to_half_of_its_last_digit() {
    let fits = |quoted: &str, value: f64| {
        let mut claim = Claim::new("", "", Verdict::Holds, "");
        claim.number("", quoted, value);
        claim.measured[0].fits
    };
    assert!(fits("0.906", 0.9064) && !fits("0.906", 0.9067) && !fits("0.906", f64::NAN));
    assert!(fits("2e-146", 2.4e-146) && !fits("2e-146", 2.6e-146) && !fits("2e-146", 2e-145));
    assert!(fits("-6389", -6389.4) && !fits("-6389", -6388.4));
    assert!(fits("1.1e3", 1149.0) && !fits("1.1e3", 1151.0));
}

#[test]
fn a_verdict_needs_every_instance() {
    let verdict = |cases: &[bool]| {
        let mut claim = Claim::new("", "", Verdict::Holds, "");
        for &holds in cases {
            claim.case("", holds);
        }
        claim.verdict()
    };
    assert_eq!(verdict(&[true, true]), Verdict::Holds);
    assert_eq!(verdict(&[true, false]), Verdict::Partly);
    assert_eq!(verdict(&[false]), Verdict::Fails);
}
