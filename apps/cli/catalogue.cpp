#include "apps/cli/catalogue.hpp"

#include <algorithm>
#include <cassert>

namespace mansard::cli {
namespace {

const char* const make = "Make building models";
const char* const city = "Run a whole city";
const char* const inspect = "Inspect and measure";
const char* const edit = "Projects";
const char* const experiment = "Test data and experiments";
const char* const look_up = "Reference";

}  // namespace

auto catalogue() -> const std::vector<VerbEntry>& {
  static const std::vector<VerbEntry> all{
      {"reconstruct",
       make,
       "Reconstruct watertight building models from meshes or point clouds, and footprints",
       {"mansard reconstruct MESH... FOOTPRINTS -o OUTDIR [options]",
        "mansard reconstruct MESH... --derive-footprints -o OUTDIR [options]"},
       {"ingest",  "cloud",   "derive", "block", "accuracy", "vegetation", "slice", "sweep",   "fracture", "segment",
        "profile", "extrude", "refine", "label", "evaluate", "solid",      "write", "texture", "terrain",  "pipeline"},
       {"--output", "--formats", "--picture", "--texture", "--derive-footprints", "--crs", "--mesh-offset", "--bbox",
        "--id-attribute", "--dtm", "--gamma", "--config", "--overwrite", "--jobs"},
       {"mansard reconstruct data/hall/mesh.off data/hall/footprints.geojson -o hall --picture",
        "mansard reconstruct data/delft/points.laz data/delft/footprints.geojson -o delft",
        "mansard reconstruct tiles/ city.gpkg --layer buildings --id-attribute bag_id -o out"}},
      {"extrude",
       make,
       "Extrude footprints by their attributes or along one profile, or rebuild models from their plans",
       {"mansard extrude FOOTPRINTS -o OUT [options]", "mansard extrude MODEL -o OUT [options]"},
       {"ingest", "extrude", "roof", "label", "solid", "write", "terrain"},
       {"--output", "--formats", "--profile", "--roof-shape", "--default-height", "--level-height", "--pitch",
        "--height-attribute", "--crs", "--where", "--extrude-overhang", "--config", "--overwrite", "--jobs"},
       {"mansard extrude footprints.gpkg -o city.glb --height-attribute h --roof-shape hipped",
        "mansard extrude hall/plans.json -o eaves.obj --extrude-overhang 0.5"}},
      {"convert",
       make,
       "Convert models that mansard wrote to any other format that it writes",
       {"mansard convert MODEL -o OUT... [options]"},
       {"extrude", "label", "solid", "write"},
       {"--output", "--to", "--write-compress", "--write-stl-shell", "--write-tile-triangles", "--extrude-overhang",
        "--config", "--overwrite", "--jobs", "--quiet"},
       {"mansard convert out/model.city.json -o city.gpkg",
        "mansard convert city.gpkg -o city.glb -o city.3dtiles -o city.stl --write-compress"}},
      {"status",
       city,
       "Show how far a run is, from any terminal",
       {"mansard status OUT [options]"},
       {},
       {},
       {"mansard status out", "watch mansard status out"}},
      {"cluster",
       city,
       "Write the job scripts that share a run among machines, and submit them",
       {"mansard cluster SCHEDULER --shares N -o FOLDER [options] -- reconstruct ..."},
       {},
       {},
       {"mansard cluster slurm --shares 64 -o jobs --submit -- reconstruct tiles/ city.gpkg -o out",
        "mansard cluster parallel --shares 8 -o jobs -- reconstruct tiles/ city.gpkg -o out"}},
      {"info",
       inspect,
       "Describe files: models, meshes, point clouds, footprints, tilesets and rasters",
       {"mansard info FILE... [options]"},
       {"cloud"},
       {"--json", "--verbose", "--cloud-building-classes", "--cloud-ground-classes", "--cloud-left-out-classes",
        "--config", "--jobs"},
       {"mansard info out/model.gpkg", "mansard info --json mesh.ply footprints.gpkg tiles/tileset.json dsm.tif"}},
      {"doctor",
       inspect,
       "Check what this machine lacks, and whether scan and footprints fit together",
       {"mansard doctor [MESH... FOOTPRINTS] [options]"},
       {"ingest", "cloud"},
       {"--json", "--crs", "--mesh-offset", "--up", "--layer", "--where", "--config", "--jobs", "--quiet"},
       {"mansard doctor", "mansard doctor mesh.ply footprints.gpkg"}},
      {"evaluate",
       inspect,
       "Compare a building model with a scan, and with a model that is known to be right",
       {"mansard evaluate MODEL MESH... [options]"},
       {"ingest", "cloud", "block", "evaluate", "pipeline"},
       {"--output", "--truth", "--footprints", "--lod", "--error-limit", "--plane-plans", "--crs", "--mesh-offset",
        "--evaluate-grid", "--evaluate-inset", "--config", "--overwrite", "--jobs", "--quiet"},
       {"mansard evaluate hall/model.city.json data/hall/mesh.off -o report.json",
        "mansard evaluate made.city.json mesh.ply --truth truth.city.json -o evaluated"}},
      {"segment",
       inspect,
       "Write the layers that show why walls were drawn or not, as a GeoPackage",
       {"mansard segment MESH... FOOTPRINTS -o OUT.gpkg [options]",
        "mansard segment MESH... --derive-footprints -o OUT.gpkg [options]"},
       {"ingest", "cloud", "derive", "block", "accuracy", "vegetation", "slice", "sweep", "fracture", "segment",
        "pipeline"},
       {"--output", "--export-mps", "--report", "--derive-footprints", "--crs", "--mesh-offset", "--bbox", "--gamma",
        "--alpha", "--beta", "--preset", "--config", "--overwrite", "--jobs"},
       {"mansard segment data/hall/mesh.off data/hall/footprints.geojson -o why.gpkg --export-mps why.mps"}},
      {"label",
       inspect,
       "Label the triangles of a mesh as wall, roof, ground or other by a model",
       {"mansard label MESH... MODEL -o MESH2 [options]"},
       {"ingest", "cloud"},
       {"--output", "--truth-mesh", "--truth", "--lod", "--reach", "--ground-height", "--crs", "--mesh-offset", "--up",
        "--config", "--overwrite", "--jobs", "--quiet"},
       {"mansard label mesh.ply out/model.city.json -o labelled.ply"}},
      {"new",
       edit,
       "Make a project of meshes and footprints, check them, and print the commands to run",
       {"mansard new PROJECT MESH... FOOTPRINTS [options]", "mansard new PROJECT FOLDER [options]"},
       {"ingest"},
       {"--no-check", "--crs", "--mesh-offset", "--up", "--layer", "--where", "--config", "--jobs", "--quiet"},
       {"mansard new my-street data/delft/mesh.ply data/delft/footprints.geojson", "mansard new my-city scans/"}},
      {"serve",
       edit,
       "View meshes and models in a browser, and edit the models",
       {"mansard serve [PROJECT] [options]"},
       {},
       {},
       {"mansard serve my-project --open"}},
      {"review",
       edit,
       "Count what people decided about the models of projects, and merge their decisions",
       {"mansard review REVIEW... [options]", "mansard review REVIEW... -o OUT.json [options]"},
       {},
       {},
       {"mansard review my-project", "mansard review north/review.json south/review.json -o both.json"}},
      {"simulate",
       experiment,
       "Simulate a scan of buildings that are known exactly: generated, or given as a model or as footprints",
       {"mansard simulate --block KIND -o OUTDIR [options]", "mansard simulate --footprints FILE -o OUTDIR [options]",
        "mansard simulate MODEL -o OUTDIR [options]"},
       {"simulate"},
       {"--output", "--block", "--footprints", "--bbox", "--points", "--picture", "--preset", "--seed", "--resolution",
        "--simulate-noise", "--config", "--overwrite", "--jobs"},
       {"mansard simulate --block terrace --preset oblique-aerial --seed 7 -o terrace --picture",
        "mansard simulate --footprints footprints.gpkg -o city"}},
      {"explore",
       experiment,
       "Run an experiment of the paper, or any option values, and write a report",
       {"mansard explore EXPERIMENT MESH... FOOTPRINTS -o OUTDIR [options]",
        "mansard explore EXPERIMENT --datasets LIST -o OUTDIR [options]"},
       {"ingest", "cloud", "block", "accuracy", "vegetation", "slice", "sweep", "fracture", "segment", "profile",
        "extrude", "refine", "label", "evaluate", "pipeline"},
       {"--output", "--grid", "--datasets", "--data", "--most-runs", "--no-pictures", "--error-limit", "--crs",
        "--mesh-offset", "--preset", "--config", "--overwrite", "--jobs"},
       {"mansard explore grid mesh.ply footprints.gpkg --grid gamma=5,10,40 -o gamma"}},
      {"options",
       look_up,
       "List all options of the modules with unit, range and default",
       {"mansard options [options]"},
       {},
       {},
       {"mansard options --all", "mansard options --attributes --json"}},
      {"explain",
       look_up,
       "Explain a diagnostic code: its cause, its remedy and its exit code",
       {"mansard explain [CODE]"},
       {},
       {},
       {"mansard explain output-exists"}},
      {"completion",
       look_up,
       "Print a script with which a shell completes verbs, options and values",
       {"mansard completion bash|zsh|fish"},
       {},
       {},
       {"source <(mansard completion bash)"}},
      {"manual", look_up, "Print the manual page", {"mansard manual"}, {}, {}, {"mansard manual | man -l -"}},
  };
  return all;
}

auto entry_of(std::string_view verb) -> const VerbEntry& {
  const auto at = std::ranges::find(catalogue(), verb, &VerbEntry::name);
  assert(at != catalogue().end());
  return *at;
}

auto add_verb(CLI::App& app, const std::string& name) -> CLI::App* {
  auto* verb = app.add_subcommand(name, entry_of(name).meaning);
  verb->set_help_flag("-h,--help", "Show this help");
  verb->set_help_all_flag("--help-all", "Show all options of this verb, by module");
  return verb;
}

}  // namespace mansard::cli
