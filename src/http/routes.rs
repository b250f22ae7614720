//! The only list of routes: routing and document both come from it.

use super::App;
use super::api::{
    albedo, diagrams, documents, figures, health, image_irradiance, limits, materials, plan, problems,
    radiance, roughness, tradeoff,
};
use super::edge::not_found;
use super::openapi;
use super::page;
use super::problem::Problem;
use axum::Router;
use utoipa::openapi::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

/// Every documented resource.
fn documented() -> OpenApiRouter<App> {
    OpenApiRouter::with_openapi(openapi::information())
        .routes(routes!(radiance::radiance))
        .routes(routes!(radiance::brdf))
        .routes(routes!(albedo::albedo))
        .routes(routes!(plan::plan))
        .routes(routes!(tradeoff::tradeoff))
        .routes(routes!(diagrams::link, diagrams::diagram))
        .routes(routes!(image_irradiance::image_irradiance))
        .routes(routes!(figures::index))
        .routes(routes!(figures::figure))
        .routes(routes!(roughness::roughness))
        .routes(routes!(materials::index))
        .routes(routes!(materials::material))
        .routes(routes!(limits::limits))
        .routes(routes!(problems::index))
        .routes(routes!(problems::problem))
        .routes(routes!(health::livez))
        .routes(routes!(health::readyz))
        .routes(routes!(health::metrics))
        .routes(routes!(documents::openapi))
}

/// The document alone.
pub(super) fn document() -> OpenApi {
    openapi::complete(documented().into_openapi())
}

/// The patterns of all paths, those of the page and the reference among them.
pub(super) fn patterns() -> Vec<String> {
    let documented = documented().into_openapi().paths.paths.into_keys();
    documented.chain(["/", "/assets/{*rest}", "/docs", "/docs/{*rest}"].map(str::to_owned)).collect()
}

/// The service's routes.
pub(super) fn routes(app: App) -> Router {
    let (router, _) = documented().split_for_parts();
    router
        .merge(documents::reference())
        .merge(page::routes())
        .fallback(|| async { Err::<(), Problem>(not_found()) })
        .with_state(app)
}
