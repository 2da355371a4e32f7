#include <locale>

// Preloaded into an executable, it makes it a host that has taken on the user's
// locale, as desktop programs do: printf and streams write what that says.
namespace {

__attribute__((constructor)) void TakeOnTheUsersLocale() {
  std::locale::global(std::locale(""));
}

}  // namespace
