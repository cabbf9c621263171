// SPDX-License-Identifier: Apache-2.0
// Any text in the place of a request of the live view's page, and any head before it. Only InputError may come out, and no head
// without the token may come in.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "sequences/files/errors.h"
#include "sequences/view/gate.h"
#include "sequences/view/view_request.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace talisman::sequences;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    view_request_from(text).plan_key();
  } catch (const InputError&) {
  }
  std::istringstream lines(text);
  RequestHead head;
  for (std::string* word : {&head.method, &head.host, &head.origin, &head.cookie, &head.content_length,
                            &head.transfer_encoding, &head.content_encoding, &head.token})
    std::getline(lines, *word);
  const Gate gate{"0123456789abcdef0123456789abcdef", 8000};
  if (text.find(gate.token) == std::string::npos && !gate.refusal(head)) std::abort();
  return 0;
}
