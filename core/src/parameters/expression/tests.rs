use super::*;
use crate::parameters::Document;

const AT: SpaceTime = SpaceTime { current: [2.0, 3.0, 5.0], initial: [7.0, 11.0, 13.0], time: 3.0 };

fn value(text: &str) -> f64 {
    Expression::parse(text).unwrap_or_else(|e| panic!("{text}: {e}")).value(&AT)
}

fn refused(text: &str) -> String {
    Expression::parse(text).map(|e| e.value(&AT)).expect_err(text).to_string()
}

#[test]
fn variables_constants_and_operators() {
    assert_eq!(value("x+10*y+100*z"), 532.0);
    assert_eq!(value("X + 100*Y + 10000*Z - t"), 131_104.0);
    assert_eq!(value("1.0 + 1.0e0*(t - 2.0)"), 2.0);
    assert_eq!(value("0.0+(8.0)*(t-1.0)/19.0"), 0.0 + 8.0 * 2.0 / 19.0);
    assert_eq!(value("7 % 4"), 3.0);
    assert_eq!(value("pi"), std::f64::consts::PI);
    assert_eq!(value("pi() * e"), std::f64::consts::PI * std::f64::consts::E);
    assert_eq!(value(".5 + 2."), 2.5);
}

#[test]
fn precedence_is_that_of_the_decks() {
    assert_eq!(value("-t^2"), 9.0);
    assert_eq!(value("2^3^2"), 64.0);
    assert_eq!(value("2**3**2"), 64.0);
    assert_eq!(value("2^-1"), 0.5);
    assert_eq!(value("10-4-3"), 3.0);
    assert_eq!(value("2*-t"), -6.0);
    assert_eq!(value("--t"), 3.0);
    assert_eq!(value("-+-+t"), 3.0);
    assert_eq!(value("12/4/3"), 1.0);
    assert_eq!(value("abs -t^2"), 9.0);
    assert_eq!(value("sqrt(4)^2*3"), 12.0);
}

#[test]
fn functions() {
    assert_eq!(value("log(1000)"), 3.0);
    assert_eq!(value("log10(1000)"), 3.0);
    assert_eq!(value("ln(e)"), 1.0);
    assert_eq!(value("exp(1)"), std::f64::consts::E);
    assert_eq!(value("atan2(1, 2)"), 1.0_f64.atan2(2.0));
    assert_eq!(value("pow(2, 10)"), 1024.0);
    assert_eq!(value("fac(5)"), 120.0);
    assert_eq!(value("fac(20)"), 2_432_902_008_176_640_000.0);
    assert_eq!(value("fac(21)"), f64::INFINITY);
    assert!(value("fac(-1)").is_nan());
    assert_eq!(value("ncr(5, 2)"), 10.0);
    assert_eq!(value("npr(5, 2)"), 20.0);
    assert!(value("ncr(2, 5)").is_nan());
    assert_eq!(value("floor(-1.5) + ceil(1.2) + abs(-2)"), 2.0);
    let at = [("sin", f64::sin as fn(f64) -> f64), ("cos", f64::cos), ("tan", f64::tan), ("sinh", f64::sinh)];
    let more = [
        ("cosh", f64::cosh as fn(f64) -> f64),
        ("tanh", f64::tanh),
        ("asin", f64::asin),
        ("acos", f64::acos),
        ("atan", f64::atan),
    ];
    for (name, f) in at.into_iter().chain(more) {
        assert_eq!(value(&format!("{name}(t/10)")), f(AT.time / 10.0), "{name}");
    }
}

#[test]
fn conditions_choose_between_two_values() {
    assert_eq!(value("1 if t < 2 else 5*t"), 15.0);
    assert_eq!(value("t^2 if t >= 3 else 0"), 9.0);
    assert_eq!(value("1 if x > y else 2"), 2.0);
    assert_eq!(value("1 if x+1 == y else 2"), 1.0);
    assert_eq!(value("1 if x <= 2 else 2"), 1.0);
    assert_eq!(value("2.0*(1.0 if t < 1 else 2.0)"), 4.0);
    assert_eq!(value("(1 if t < 1 else 2) + sqrt(4 if t > 1 else 9)^2*(3 if x < y else 0)"), 14.0);
    assert_eq!(value("1 if t < 1 else (2 if t < 2 else (3 if t < 3 else 4))"), 4.0);
    assert_eq!(value("(t if (1 if t < 1 else 2) == 2 else 0)"), 3.0);
    assert!(refused("2*(1 if t < 2)").contains("expected else, found"));
    assert!(refused("1 if t else 2").contains("expected <, <=, >, >= or =="));
    assert!(refused("1 if t < 2").contains("expected else, found the end"));
    assert!(refused("t < 2").contains("compare only in: A if LEFT < RIGHT else B"));
    assert!(refused("1 if t > 1 and t < 2 else 3").contains("a condition is one comparison"));
}

#[test]
fn dependence_on_space_and_time_is_known() {
    let uses = |text: &str| {
        let e = Expression::parse(text).unwrap();
        (e.uses_space(), e.uses_time())
    };
    assert_eq!(uses("exp(1)"), (false, false));
    assert_eq!(uses("exp(t)"), (false, true));
    assert_eq!(uses("Y"), (true, false));
    assert_eq!(uses("1 if t < 1 else x"), (true, true));
}

#[test]
fn errors_name_the_character() {
    assert_eq!(
        refused("1 + sine(t)"),
        "character 5: unknown name \"sine\"; did you mean \"sin\" or \"sinh\"? known names: x y z X Y Z t e pi abs acos \
         asin atan atan2 ceil cos cosh exp fac floor ln log log10 ncr npr pow sin sinh sqrt tan tanh"
    );
    assert!(refused("max(1, t)").starts_with("character 1: unknown name \"max\""));
    assert_eq!(refused(""), "character 1: expected a value, found the end");
    assert_eq!(refused("2 t"), "character 3: expected an operator or the end, found \"t\"");
    for text in ["1,5*t", "(1,5)*t", "1 if t < 1,5 else 2"] {
        assert!(refused(text).contains("found \",\"") && refused(text).contains("write 1.5 for 1,5"), "{text}");
    }
    assert_eq!(refused("(1"), "character 3: expected \")\", found the end");
    assert_eq!(refused("pow(1)"), "character 6: expected \",\" and the second argument, found \")\"");
    assert_eq!(refused("é"), "character 1: the character 'é' has no meaning here");
    assert_eq!(refused("1 = 2"), "character 3: the character '=' has no meaning here");
    assert_eq!(refused("."), "character 1: a number needs at least one digit");
    for text in ["1e", "+", "t*", "sin", "sin()", "pi(1)", "1 2", ")", ",", "1,", "x y", "if", "1 if 2 < 3 else", "T"] {
        refused(text);
    }
    let node = Document::from_str("\n  \"2*q\"", "deck.json").unwrap().root;
    let said = Expression::from_node(&node).unwrap_err().to_string();
    assert!(said.starts_with("error[invalid-expression] deck.json:2:6: in \"2*q\": unknown name \"q\""), "{said}");
}

#[test]
fn deep_nesting_is_refused_not_fatal() {
    assert!(refused(&"(".repeat(100_000)).contains("nested more than"));
    assert!(refused(&format!("{}1", "1+(".repeat(90))).contains("values are pending"));
    assert_eq!(value(&["1"; 10_000].join("+")), 10_000.0);
    assert_eq!(value(&format!("{}t", "-".repeat(10_000))), 3.0);
}

#[test]
fn no_text_makes_it_panic() {
    let pieces = [
        "x", "t", "1", "2.5", "e", "pi", "sin", "pow", "(", ")", ",", "+", "-", "*", "/", "%", "^", " if ", " else ",
        "<", "==", "1e", "é", " ", "q",
    ];
    let mut seed = 7_u64;
    let mut random = move |below: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % below
    };
    let mut compiled = 0;
    for round in 0..50_000 {
        let length = random(14);
        let text: String = if round % 3 > 0 {
            (0..length).map(|_| pieces[random(pieces.len())]).collect()
        } else {
            String::from_utf8_lossy(&(0..length).map(|_| random(256) as u8).collect::<Vec<_>>()).into_owned()
        };
        if let Ok(expression) = Expression::parse(&text) {
            expression.value(&AT);
            compiled += 1;
        }
    }
    assert!(compiled > 500, "{compiled}");
}
