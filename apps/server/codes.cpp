// The diagnostic codes of the server, as `mansard explain` prints them.
#include "apps/server/server.hpp"

namespace mansard::server {

auto codes() -> std::vector<base::Code> {
  constexpr int usage = 2, unreadable = 3, bug = 70;
  return {
      {"server-folder", "The folder is not empty and is not a mansard project.",
       "Give the folder of a project, an empty folder, or the name of a new one.", usage},
      {"server-locked",
       "The project is open in another 'mansard serve'. Two servers would overwrite each other's files.",
       "Use the page of the running server, or stop it first.", usage},
      {"server-project", "A file of the project cannot be read: it is damaged, or another version of mansard wrote it.",
       "Restore the file from a backup, or move it away. The results of the runs are in the folder 'runs'.",
       unreadable},
      {"server-port", "The server cannot listen on this address and port.",
       "Choose another port with --port, or 0 for any free port.", usage},
      {"server-random", "The operating system provides no random numbers, so no access token can be made.",
       "Check the machine. Nothing is served without a token.", bug},
      {"server-token", "The request has no access token, or not the token of the running server.",
       "Open the link that 'mansard serve' printed last.", usage},
      {"server-host",
       "The request names another host than this server. Another site may have redirected its name to this machine.",
       "Open the link that 'mansard serve' printed.", usage},
      {"server-origin", "The request comes from a page of another server.",
       "Open the link that 'mansard serve' printed.", usage},
      {"server-path", "The server has no such path.", "/api/openapi.json lists all calls.", usage},
      {"server-method", "The path does not support this HTTP method.", "/api/openapi.json lists all calls.", usage},
      {"server-body", "The request cannot be read, or a member is missing or not valid.",
       "Correct the place that the message names.", usage},
      {"server-large", "The request is too large: a JSON body above 16 MB, or a file above the upload limit.",
       "Send less. Give the path of a large file instead of uploading it, or raise --upload-limit.", usage},
      {"server-upload", "The name of the uploaded file is not valid, or the folder to put it into.",
       "Rename the file: at most 128 bytes of UTF-8, no '/', '\\' and control characters, no leading dot, no space at "
       "either end. Folders are integers from 2.",
       usage},
      {"server-exists", "The project has another file of this name. Inputs are never replaced.",
       "Upload the file into another folder of the inputs (?folder=2), or rename it.", usage},
      {"server-changed", "An input is not the file from which the runs of the project were made.",
       "Restore the file, delete the runs and read the inputs again, or start 'mansard serve' with another folder.",
       unreadable},
      {"server-damaged", "The record of a run cannot be read: it is damaged, or another version of mansard wrote it.",
       "Restore run.json from a backup, or delete the run. The other runs of the project are not affected.",
       unreadable},
      {"server-sample", "No sample is available, or it cannot be read.",
       "Start 'mansard serve' with --sample and a folder with meshes and footprints.", usage},
      {"server-unknown", "The request names a run, job, tile, error map or file that does not exist.",
       "It may have been deleted. Fetch the list again.", usage},
      {"server-no-scene", "The inputs have not been read: none were given, reading has not ended, or it failed.",
       "Open inputs, wait until they have been read, or correct what the message names.", usage},
      {"server-not-done", "The run has no results: it has not ended, it failed, or it was cancelled.",
       "Wait until it is done, or start it again.", usage},
      {"server-busy", "The request has to wait: inputs are being read, or the run to delete has not ended.",
       "Wait until the job has ended, or cancel it.", usage},
      {"server-inputs", "The project has runs with other inputs. All runs of a project share the same inputs.",
       "Delete the runs, or start 'mansard serve' with another folder.", usage},
      {"server-input", "A database is given for a mesh or a raster.",
       "Databases can hold footprints only. Give a file, folder, archive or tileset for a mesh.", usage},
      {"server-import", "The models to open are in another CRS than the mesh of the project.",
       "Open them in a project of their own, or convert them to the CRS of the mesh.", usage},
      {"server-listeners", "Too many pages are connected to the server.", "Close some of them.", usage},
      {"edit-invalid", "The edit was not applied: a building's models would not be valid.",
       "Correct what the message names in the plan, and apply the edit again.", usage},
  };
}

}  // namespace mansard::server
