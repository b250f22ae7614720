//! Makes the page at `/` part of the program: its files and the plot library packed once, under names that follow from
//! their content. The library comes out of the `plotly` crate.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "server")]
    page::build()?;
    Ok(())
}

#[cfg(feature = "server")]
mod page {
    use flate2::Compression;
    use flate2::write::GzEncoder;
    use std::error::Error;
    use std::fmt::Write as _;
    use std::hash::{DefaultHasher, Hasher as _};
    use std::io::Write as _;
    use std::path::{Path, PathBuf};
    use std::{env, fs};

    /// Where the page is made.
    const SOURCE: &str = "src/http/page";
    /// The plot library's file.
    const LIBRARY: &str = "plotly.min.js";

    /// Writes the packed files, and `page.rs` that includes them.
    pub(super) fn build() -> Result<(), Box<dyn Error>> {
        println!("cargo::rerun-if-changed={SOURCE}");
        let out = PathBuf::from(env::var("OUT_DIR")?);
        let files = files()?;
        let library = library()?;
        // Scripts import each other by their names, so that one directory has one version of all of them.
        let directory = format!("assets/{}", key(&files));
        let library_directory = format!("assets/{}", key(&library));

        let mut code = String::from(
            "/// Every file, by its path behind the service's root.\nstatic FILES: &[File] = &[\n",
        );
        for (name, content) in &files {
            entry(&mut code, &out, &directory, name, content.as_bytes())?;
        }
        entry(&mut code, &out, &library_directory, LIBRARY, library.as_bytes())?;
        code.push_str("];\n");
        fs::write(out.join("page.rs"), code)?;

        let preloads: Vec<String> = files
            .iter()
            .filter(|(name, _)| extension(name) == Some("js"))
            .map(|(name, _)| format!("<link rel=\"modulepreload\" href=\"{directory}/{name}\">"))
            .collect();
        let html = fs::read_to_string(Path::new(SOURCE).join("index.html"))?
            .replace("{assets}", &directory)
            .replace("{plotly}", &format!("{library_directory}/{LIBRARY}"))
            .replace("{preloads}", &preloads.join("\n"));
        fs::write(out.join("index.html"), html)?;
        Ok(())
    }

    fn extension(name: &str) -> Option<&str> {
        Path::new(name).extension()?.to_str()
    }

    /// Names and contents, in the order of the names.
    fn files() -> Result<Vec<(String, String)>, Box<dyn Error>> {
        let mut files = Vec::new();
        for entry in fs::read_dir(Path::new(SOURCE).join("assets"))? {
            let entry = entry?;
            let name =
                entry.file_name().into_string().map_err(|name| format!("{} is no name", name.display()))?;
            files.push((name, fs::read_to_string(entry.path())?));
        }
        files.sort();
        Ok(files)
    }

    /// The plot library: the first script of those that the crate has for pages without a network.
    fn library() -> Result<String, Box<dyn Error>> {
        let sources = plotly::Plot::offline_js_sources();
        let script = sources.split_once("<script type=\"text/javascript\">").map(|(_, rest)| rest);
        // The library holds the text of a closing tag nowhere else, or it could not stand in a page.
        let script = script.and_then(|rest| rest.split_once("</script>")).map(|(script, _)| script);
        script
            .filter(|script| script.contains("plotly.js v"))
            .map(str::to_owned)
            .ok_or_else(|| "the plotly crate has its scripts in another form".into())
    }

    /// The same for the same content, on every machine.
    fn key(of: &impl std::hash::Hash) -> String {
        let mut hasher = DefaultHasher::new();
        of.hash(&mut hasher);
        format!("{:016x}", hasher.finish())
    }

    /// Packs a file, and adds its line.
    fn entry(
        code: &mut String,
        out: &Path,
        directory: &str,
        name: &str,
        content: &[u8],
    ) -> Result<(), Box<dyn Error>> {
        let packed = out.join(format!("{name}.gz"));
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(content)?;
        fs::write(&packed, encoder.finish()?)?;
        let content_type = match extension(name) {
            Some("js") => "text/javascript; charset=utf-8",
            Some("css") => "text/css; charset=utf-8",
            Some("svg") => "image/svg+xml",
            _ => return Err(format!("{name} is of no kind that the page is made of").into()),
        };
        writeln!(
            code,
            "    File {{ path: \"{directory}/{name}\", content_type: \"{content_type}\", packed: include_bytes!(concat!(env!(\"OUT_DIR\"), \"/{name}.gz\")) }},"
        )?;
        Ok(())
    }
}
