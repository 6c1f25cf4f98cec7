#pragma once

namespace yuragi::daemon::service {

/// Holds SIGHUP back until a Service takes it, so that none is lost. Call it before the configuration is read, and
/// before there are threads.
void hold_back_hangups();

}  // namespace yuragi::daemon::service
