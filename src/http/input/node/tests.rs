use super::{Node, parse};

fn refused(text: &str) -> String {
    parse(text.as_bytes()).unwrap_err().detail
}

#[test]
fn numbers_are_the_nearest_doubles() {
    for (text, value) in
        [("0.1", 0.1), ("5e-324", 5e-324), ("1.7976931348623157e308", f64::MAX), ("-0.0", 0.0)]
    {
        assert_eq!(parse(text.as_bytes()).unwrap(), Node::Number(value));
    }
    // Halfway between two doubles but for the last digit.
    assert_eq!(parse(b"9007199254740993.00000001").unwrap(), Node::Number(9007199254740994.0));
}

#[test]
fn broken_json_says_where_and_what() {
    assert!(refused("{\"a\": 1,\n \"b\" 2}").contains("line 2 column"));
    assert!(refused("").contains("empty"));
    for text in ["{\"a\": NaN}", "[-Infinity]", "[1, Infinity]", "nan", "[+Infinity]"] {
        assert!(refused(text).contains("no NaN"), "{text}: {}", refused(text));
    }
    assert!(!refused("{\"a\": nil}").contains("NaN"));
    assert!(refused(&"[".repeat(10_000)).contains("recursion"));
    assert!(parse(b"{\"a\": \"\xff\"}").is_err());
    assert!(parse(b"1 2").is_err());
}

#[test]
fn what_f64_cannot_hold_becomes_a_string() {
    let Node::Object(object) = parse(br#"{"a": 1e400, "b": [1, -1e999], "c": "1e400 \" 2e500"}"#).unwrap()
    else {
        panic!("not an object");
    };
    assert_eq!(object.fields[0].1, Node::Text("1e400".to_owned()));
    let Node::Array(array) = &object.fields[1].1 else { panic!("not an array") };
    assert_eq!(array.others, [(1, Node::Text("-1e999".to_owned()))]);
    assert_eq!(object.fields[2].1, Node::Text("1e400 \" 2e500".to_owned()));
    assert!(refused("{\"a\": 1e400, ").contains("EOF"));
    let place = "expected value at line 1 column 19";
    assert!(refused(r#"{"a": 1e400, "b": }"#).contains(place), "{}", refused(r#"{"a": 1e400, "b": }"#));
    assert_eq!(refused(r#"{"a": 1e400, "b": }"#), refused(r#"{"a": 1e200, "b": }"#));
    assert!(refused(r#"{"a": -1e400, 1e400: 2}"#).contains("key must be a string"));
}

#[test]
fn duplicates_are_kept_apart() {
    let Node::Object(object) = parse(br#"{"a": 1, "a": 2}"#).unwrap() else { panic!("not an object") };
    assert_eq!(object.duplicates, ["a"]);
    assert_eq!(object.fields.len(), 1);
}

#[test]
fn a_body_of_many_values_is_refused_before_it_costs_memory() {
    let text = format!("[{}]", vec!["[]"; 5000].join(","));
    assert!(parse(text.as_bytes()).unwrap_err().oversized);
    let Node::Array(array) = parse(format!("[{}]", vec!["1"; 5000].join(",")).as_bytes()).unwrap() else {
        panic!("not an array");
    };
    assert_eq!(array.numbers.len(), 5000);
}
