#ifndef FINRAY_EXPORT_H_
#define FINRAY_EXPORT_H_

/// Marks what the shared library shows.
#define FINRAY_API __attribute__((visibility("default")))

// Inside the library namespace finray holds the internal classes, some of which
// have the same names.
#ifndef FINRAY_INSIDE
namespace finray {
/// The public interface, version 1. Its names are in namespace finray too:
/// write finray::Finger.
namespace v1 {}
using namespace v1;  // NOLINT(google-build-using-namespace)
}  // namespace finray
#endif

#endif  // FINRAY_EXPORT_H_
