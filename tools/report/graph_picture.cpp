#include "tools/report/graph_picture.h"
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <unistd.h>
#include "tools/report/assets.h"
#include "tools/report/child_process.h"
#include "tools/report/typography.h"

namespace loopwright::report {
namespace {

/// A folder for the files of a browser, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "loopwright-picture-XXXXXX").string();
    if (mkdtemp(pattern.data())) path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A call of diagramFile with its data; `elk` is an instance of the layout library.
std::string drawing_script(const Graph& graph, const GraphOptions& options) {
  return fmt::format("{}\nconst drawing = (elk) => diagramFile(elk, {}, {}, {{ page: {}, diagram: {} }});\n",
                     assets::diagram_file_js, graph_json(graph), options.depth, json_string(assets::page_css),
                     json_string(assets::diagram_css));
}

ChildResult draw_with_node(const std::string& program, const Graph& graph, const GraphOptions& options) {
  const std::string script = fmt::format(
      "{}\nconst source = require(\"zlib\").gunzipSync(Buffer.from(\"{}\", \"base64\")).toString();\n"
      "const made = {{ exports: {{}} }};\n"
      "new Function(\"module\", \"exports\", \"require\", source)(made, made.exports, require);\n"
      "drawing(new made.exports()).then((svg) => process.stdout.write(svg),\n"
      "  (error) => {{ process.stderr.write(String(error.message) + \"\\n\"); process.exitCode = 1; }});\n",
      drawing_script(graph, options), assets::elk_packed);
  return run_program({program, "-"}, script, options.time_limit);
}

std::vector<std::string> browser(const std::string& program, const std::filesystem::path& folder) {
  return {program,
          "--headless",
          "--no-sandbox",
          "--disable-gpu",
          "--disable-background-networking",
          "--no-first-run",
          "--hide-scrollbars",
          "--user-data-dir=" + (folder / "profile").string()};
}

/// The page leaves the picture, encoded, in the title of its document.
ChildResult draw_with_browser(const std::string& program, const Graph& graph, const GraphOptions& options) {
  const TemporaryFolder folder;
  const std::filesystem::path page = folder.path() / "page.html";
  std::ofstream(page) << fmt::format(
      "<!DOCTYPE html><meta charset=\"utf-8\"><script type=\"text/plain\" "
      "id=\"elk\">{}</script><script>\n{}\n"
      "(async () => {{\n"
      "  const bytes = Uint8Array.from(atob(document.getElementById(\"elk\").textContent), (c) => "
      "c.charCodeAt(0));\n"
      "  const text = await new Response(new Blob([bytes]).stream().pipeThrough(new "
      "DecompressionStream(\"gzip\"))).text();\n"
      "  const script = document.createElement(\"script\"); script.textContent = text; "
      "document.head.append(script);\n"
      "  const svg = await drawing(new ELK());\n"
      "  document.documentElement.innerHTML = \"[[\" + encodeURIComponent(svg) + \"]]\";\n"
      "}})();\n</script>",
      assets::elk_packed, drawing_script(graph, options));
  std::vector<std::string> arguments = browser(program, folder.path());
  arguments.insert(arguments.end(), {"--virtual-time-budget=60000", "--dump-dom", "file://" + page.string()});
  ChildResult result = run_program(arguments, "", options.time_limit);
  if (!result.succeeded) return result;
  const std::size_t begin = result.output.find("[["), end = result.output.find("]]", begin);
  if (begin == std::string::npos || end == std::string::npos)
    return {false, {}, program + " gave no picture"};
  std::string svg;
  for (std::size_t i = begin + 2; i < end; ++i)
    if (result.output[i] == '%') {
      svg += char(std::stoi(result.output.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      svg += result.output[i];
    }
  return {true, std::move(svg), {}};
}

/// The number of an attribute of the first element: width="830".
double attribute(const std::string& svg, std::string_view name) {
  const std::size_t at = svg.find(fmt::format(" {}=\"", name));
  return at == svg.npos ? 0 : std::strtod(svg.c_str() + at + name.size() + 3, nullptr);
}

std::string content(const std::filesystem::path& path) {
  std::ostringstream bytes;
  bytes << std::ifstream(path, std::ios::binary).rdbuf();
  return std::move(bytes).str();
}

}  // namespace

GraphPicture draw_svg(const Graph& graph, const GraphOptions& options) {
  std::string failures;
  for (const std::string& program : options.interpreters) {
    const bool is_browser = program.find("chrom") != program.npos;
    ChildResult result =
        is_browser ? draw_with_browser(program, graph, options) : draw_with_node(program, graph, options);
    if (result.succeeded && result.output.starts_with("<svg")) return {std::move(result.output), {}};
    failures += "\n  " + (result.succeeded ? program + " gave no picture" : result.failure);
  }
  return {{},
          "the diagram could not be drawn; this needs node or chromium (Debian packages nodejs, chromium):" +
              failures};
}

GraphPicture draw_png(const Graph& graph, const GraphOptions& options) {
  GraphPicture drawn = draw_svg(graph, options);
  if (drawn.bytes.empty()) return drawn;
  const TemporaryFolder folder;
  const auto page = folder.path() / "page.html", picture = folder.path() / "picture.png";
  std::ofstream(page)
      << "<!DOCTYPE html><meta charset=\"utf-8\"><style>body { margin: 0; } svg { display: block; }</style>"
      << drawn.bytes;
  std::vector<std::string> arguments = browser(options.rasterizer, folder.path());
  arguments.insert(arguments.end(),
                   {"--force-device-scale-factor=2", "--screenshot=" + picture.string(),
                    fmt::format("--window-size={:.0f},{:.0f}", std::ceil(attribute(drawn.bytes, "width")),
                                std::ceil(attribute(drawn.bytes, "height"))),
                    "file://" + page.string()});
  const ChildResult result = run_program(arguments, "", options.time_limit);
  std::string bytes = content(picture);
  if (bytes.empty())
    return {{},
            "the picture could not be written as PNG; this needs chromium (Debian package chromium):\n  " +
                (result.succeeded ? options.rasterizer + " gave no picture" : result.failure)};
  return {std::move(bytes), {}};
}

}  // namespace loopwright::report
