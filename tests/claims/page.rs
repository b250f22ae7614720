//! `docs/claims.md`: every statement with its numbers. `UPDATE_CLAIMS=1 cargo test --test claims` rewrites it.

use crate::claim::Claim;
use std::fmt::Write as _;
use std::path::PathBuf;

const BEGIN: &str = "<!-- claims: begin -->\n";
const END: &str = "<!-- claims: end -->\n";

/// A table of the verdicts, then every statement's numbers.
fn write(topics: &[(&str, Vec<Claim>)]) -> String {
    let mut text = String::from("| where | the report says | verdict |\n| --- | --- | --- |\n");
    for claim in topics.iter().flat_map(|(_, claims)| claims) {
        writeln!(text, "| {} | {} | {} |", claim.place, claim.says, claim.verdict().name()).expect("string");
    }
    for (topic, claims) in topics {
        writeln!(text, "\n## {topic}").expect("string");
        for claim in claims {
            writeln!(text, "\n### {}\n\n{}: **{}**.", claim.says, claim.place, claim.verdict().name())
                .expect("string");
            for (word, which) in [("True", true), ("Not true", false)] {
                let instances = claim.instances(which);
                if !instances.is_empty() {
                    writeln!(text, "\n{word}: {instances}.").expect("string");
                }
            }
            if !claim.remark.is_empty() {
                writeln!(text, "\n{}", claim.remark).expect("string");
            }
            text.push_str("\n| what | expected | measured |\n| --- | --- | --- |\n");
            for row in &claim.measured {
                writeln!(text, "| {} | {} | {} |", row.what, row.expected, row.found).expect("string");
            }
        }
    }
    text
}

/// Compares the page with the measurement, or rewrites it.
pub(crate) fn hold(topics: &[(&str, Vec<Claim>)]) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("docs/claims.md");
    let document = std::fs::read_to_string(&path).expect("docs/claims.md");
    let (before, rest) = document.split_once(BEGIN).expect("begin mark");
    let (committed, after) = rest.split_once(END).expect("end mark");
    let measured = write(topics);
    println!("{measured}");
    if std::env::var_os("UPDATE_CLAIMS").is_some() {
        std::fs::write(&path, [before, BEGIN, &measured, END, after].concat()).expect("docs/claims.md");
        return;
    }
    let stale = committed.lines().zip(measured.lines()).find(|(a, b)| a != b);
    assert_eq!(
        committed.lines().count(),
        measured.lines().count(),
        "docs/claims.md is out of date (UPDATE_CLAIMS=1 rewrites it): {stale:?}"
    );
    assert_eq!(stale, None, "docs/claims.md is out of date (UPDATE_CLAIMS=1 rewrites it)");
}
