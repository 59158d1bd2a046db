#include "contents.hpp"
#include "ingest/input_file.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

std::unique_ptr<MatContents> contents_of_version_73(std::shared_ptr<const InputFile> file) {
  throw InputError("is a MATLAB file of version 7.3, which this build leaves out",
                   "save it again with save(..., '-v7'), or build where libmatio is installed (scripts/setup matlab)",
                   {file->path(), 0, ""});
}

}  // namespace tribofit
