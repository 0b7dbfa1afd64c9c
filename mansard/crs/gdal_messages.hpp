// What GDAL and PROJ say goes here, not to the terminal.
#pragma once

#include <cpl_error.h>
#include <string>

namespace mansard::crs {

/// Catches the messages of this thread for as long as it lives.
class GdalMessages {
 public:
  GdalMessages() { CPLPushErrorHandlerEx(&GdalMessages::take, this); }
  GdalMessages(const GdalMessages&) = delete;
  auto operator=(const GdalMessages&) -> GdalMessages& = delete;
  ~GdalMessages() { CPLPopErrorHandler(); }

  /// The first failure, on one line; empty when there was none.
  [[nodiscard]] auto failure() const -> const std::string& { return failure_; }
  void forget() { failure_.clear(); }

 private:
  static void CPL_STDCALL take(CPLErr kind, CPLErrorNum, const char* words) {
    auto* self = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
    if (kind < CE_Failure || !self->failure_.empty()) return;
    self->failure_ = words;
    for (char& c : self->failure_) c = c == '\n' || c == '\r' ? ' ' : c;
  }
  std::string failure_;
};

}  // namespace mansard::crs
