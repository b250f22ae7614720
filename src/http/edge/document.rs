//! What the document says about keys and allowances: the same for every operation of a class.

use super::route::{Class, class};
use crate::http::api::responses;
use crate::http::problem::Kind;
use utoipa::openapi::OpenApi;
use utoipa::openapi::path::Operation;
use utoipa::openapi::security::{Http, HttpAuthScheme, SecurityRequirement, SecurityScheme};

/// The scheme's name in the document.
const BEARER: &str = "key";
const DESCRIPTION: &str = "A key that the operator of the service gave out. Only needed where the service was started \
with keys; otherwise anybody may ask.";

/// Adds the scheme, and to every operation whether it takes part and how it refuses.
pub(crate) fn complete(document: &mut OpenApi) {
    let scheme = Http::builder().scheme(HttpAuthScheme::Bearer).description(Some(DESCRIPTION)).build();
    let components = document.components.get_or_insert_default();
    components.security_schemes.insert(BEARER.to_owned(), SecurityScheme::Http(scheme).into());
    for (path, item) in &mut document.paths.paths {
        let class = class(path);
        for operation in [&mut item.get, &mut item.post].into_iter().flatten() {
            complete_operation(operation, class);
        }
    }
}

fn complete_operation(operation: &mut Operation, class: Class) {
    let guarded = matches!(class, Class::Guarded | Class::Metrics);
    operation.security = Some(if guarded {
        let nobody: [&str; 0] = [];
        vec![SecurityRequirement::default(), SecurityRequirement::new(BEARER, nobody)]
    } else {
        Vec::new()
    });
    let mut problems = Vec::new();
    if guarded {
        problems.push((Kind::Unauthorized, "No key was sent, or one that is not in force."));
    }
    if matches!(class, Class::Guarded | Class::Open) {
        problems.push((Kind::RateLimited, "The client asked too often; the detail says how often it may."));
        problems.push((Kind::Overloaded, "There is more work than the service takes on; nothing was begun."));
    }
    for (status, response) in responses::list(&problems) {
        operation.responses.responses.entry(status).or_insert(response);
    }
}
