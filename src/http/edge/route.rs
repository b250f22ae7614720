//! Which route a path is: its pattern for logs and metrics, and who may ask for it.

use crate::http::routes;
use std::collections::HashMap;
use std::sync::LazyLock;

/// Who may ask for a route, and what counts against it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// Asked by balancers and monitors, whatever else goes on: no key, no rate limit, never shed.
    Health,
    /// Asked by a monitor whatever else goes on, with a key where there are keys.
    Metrics,
    /// What the service says about itself: no key.
    Open,
    /// Everything else, paths that do not exist among them.
    Guarded,
}

/// A route.
#[derive(Debug)]
pub(super) struct Route {
    /// Its place in the list.
    pub(super) index: usize,
    /// The path with its parameters in braces.
    pub(super) pattern: String,
    pub(super) class: Class,
}

/// Every route, the last for paths that are none.
#[derive(Debug)]
pub(super) struct Routes {
    all: Vec<Route>,
    exact: HashMap<String, usize>,
    with_parameter: Vec<WithParameter>,
}

/// A pattern with a parameter, taken apart.
#[derive(Debug)]
struct WithParameter {
    before: String,
    after: String,
    /// Whether the parameter takes segments as they come.
    any: bool,
    index: usize,
}

impl WithParameter {
    fn of(pattern: &str, index: usize) -> Option<Self> {
        let (before, rest) = pattern.split_once('{')?;
        let (name, after) = rest.split_once('}')?;
        let any = name.starts_with('*');
        Some(Self { before: before.to_owned(), after: after.to_owned(), any, index })
    }

    fn fits(&self, path: &str) -> bool {
        path.strip_prefix(&self.before)
            .and_then(|rest| rest.strip_suffix(&self.after))
            .is_some_and(|value| self.any || !value.is_empty() && !value.contains('/'))
    }
}

/// The pattern of paths that are no route: one label, however many paths strangers try.
pub(super) const NO_ROUTE: &str = "none";
/// Before the paths of one version.
const VERSION_PREFIX: &str = concat!("/", env!("CARGO_PKG_VERSION"));

static ROUTES: LazyLock<Routes> = LazyLock::new(|| {
    let mut patterns: Vec<String> = routes::patterns();
    patterns.push(NO_ROUTE.to_owned());
    Routes::new(patterns)
});

/// Every route of the service.
pub(super) fn all() -> &'static [Route] {
    &ROUTES.all
}

/// The class of a pattern.
pub(super) fn class(pattern: &str) -> Class {
    match pattern {
        "/livez" | "/readyz" => Class::Health,
        "/metrics" => Class::Metrics,
        "/" | "/openapi.json" => Class::Open,
        _ if ["/assets", "/docs", "/problems"].iter().any(|open| pattern.starts_with(open)) => Class::Open,
        _ => Class::Guarded,
    }
}

/// The route of a path.
pub(super) fn of(path: &str) -> &'static Route {
    ROUTES.of(path)
}

impl Routes {
    fn new(patterns: Vec<String>) -> Self {
        let mut exact = HashMap::new();
        let mut with_parameter = Vec::new();
        for (index, pattern) in patterns.iter().enumerate() {
            match WithParameter::of(pattern, index) {
                Some(parts) => with_parameter.push(parts),
                None => {
                    exact.insert(pattern.clone(), index);
                }
            }
        }
        let all = patterns.into_iter().enumerate();
        let all =
            all.map(|(index, pattern)| Route { index, class: class(&pattern), pattern }).collect::<Vec<_>>();
        Self { all, exact, with_parameter }
    }

    fn of(&self, path: &str) -> &Route {
        let path = path.strip_prefix(VERSION_PREFIX).unwrap_or(path);
        let place = self.exact.get(path).copied().or_else(|| {
            self.with_parameter.iter().find(|pattern| pattern.fits(path)).map(|pattern| pattern.index)
        });
        &self.all[place.unwrap_or(self.all.len() - 1)]
    }
}

#[cfg(test)]
mod tests {
    use super::{Class, NO_ROUTE, of};

    #[test]
    fn paths_have_their_patterns() {
        for (path, pattern, class) in [
            ("/v1/radiance", "/v1/radiance", Class::Guarded),
            ("/v1/figures/23c", "/v1/figures/{id}", Class::Guarded),
            ("/v1/figures", "/v1/figures", Class::Guarded),
            (concat!("/", env!("CARGO_PKG_VERSION"), "/v1/diagrams"), "/v1/diagrams", Class::Guarded),
            ("/livez", "/livez", Class::Health),
            ("/metrics", "/metrics", Class::Metrics),
            ("/", "/", Class::Open),
            ("/assets/0/app.js", "/assets/{*rest}", Class::Open),
            ("/docs", "/docs", Class::Open),
            ("/docs/", "/docs/{*rest}", Class::Open),
            ("/docs/swagger-ui.css", "/docs/{*rest}", Class::Open),
            ("/openapi.json", "/openapi.json", Class::Open),
            ("/v1/figures/", NO_ROUTE, Class::Guarded),
            ("/v1/figures/23c/more", NO_ROUTE, Class::Guarded),
            ("/v1/nothing", NO_ROUTE, Class::Guarded),
            ("", NO_ROUTE, Class::Guarded),
            ("*", NO_ROUTE, Class::Guarded),
            ("//livez", NO_ROUTE, Class::Guarded),
        ] {
            let route = of(path);
            assert_eq!((route.pattern.as_str(), route.class), (pattern, class), "{path}");
        }
    }
}
