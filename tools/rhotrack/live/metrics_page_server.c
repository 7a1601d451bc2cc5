/* SPDX-License-Identifier: MIT */
#include "live/metrics_page_server.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/common.h"

enum {
    PLACES = 16,
    REQUEST_BYTES = 4096,
    ACCEPTED_MAX = 16, /* most connections accepted in one call */
    LIFE_US = 2000000,
    FRESH_US = 100000 /* a page younger than this is sent again without being made anew */
};

enum client_state {
    CLIENT_NONE = 0,
    CLIENT_ASKS,
    CLIENT_READS,
    CLIENT_ENDS /* the answer is sent; further data from the client are ignored */
};

struct client {
    enum client_state state;
    int descriptor;
    int64_t since_us;
    size_t num_asked; /* bytes received of the request */
    char asked[REQUEST_BYTES];
    char *answer;
    size_t num_answer, sent;
};

struct page_server {
    int listener, poll;
    /* accepting is paused, as no descriptor is free: new connections wait in the kernel's queue */
    bool is_deaf;
    const char *path, *type;
    page_server_write *write;
    void *context;
    char *page; /* the page that was made last */
    size_t num_page;
    int64_t page_us; /* monotonic time at which the page was made */
    uint64_t sent, refused;
    struct client clients[PLACES];
};

/* ---- Clients ---- */

/*
 * Closes a client's connection. Removes it from epoll and shuts it down explicitly: forked
 * processes that save files hold copies of the descriptor, so that close alone does neither.
 */
static void close_client(const struct page_server *server, struct client *client)
{
    (void)epoll_ctl(server->poll, EPOLL_CTL_DEL, client->descriptor, NULL);
    shutdown(client->descriptor, SHUT_RDWR);
    close(client->descriptor);
    free(client->answer);
    client->answer = NULL;
    client->num_asked = client->num_answer = client->sent = 0;
    client->state = CLIENT_NONE;
}

/* Returns a free client place; if there is none, drops the client that connected first. */
static struct client *claim_client_place(struct page_server *server)
{
    struct client *found = &server->clients[0];

    for (unsigned i = 0; i < PLACES; i++) {
        struct client *client = &server->clients[i];

        if (client->state == CLIENT_NONE) {
            return client;
        }
        found = client->since_us < found->since_us ? client : found;
    }
    server->refused += found->state != CLIENT_ENDS;
    close_client(server, found);
    return found;
}

/* ---- Answers ---- */

/* Makes the page anew unless it is younger than FRESH_US; false where memory is out. */
static bool have_fresh_page(struct page_server *server)
{
    const int64_t now_us = monotonic_clock_us();
    FILE *out;

    if (server->page && now_us < server->page_us + FRESH_US) {
        return true;
    }
    free(server->page);
    server->page = NULL;
    out = open_memstream(&server->page, &server->num_page);
    if (!out) {
        return false;
    }
    server->write(out, server->context);
    if (fclose(out)) {
        free(server->page);
        server->page = NULL;
    }
    server->page_us = now_us;
    return server->page != NULL;
}

/*
 * Prepares an HTTP answer. extra: further header lines, each with its line end; has_text false:
 * headers only (HEAD).
 */
static void prepare_answer(const struct page_server *server, struct client *client,
                           const char *status, const char *extra, const char *type,
                           const char *text, size_t size, bool has_text)
{
    FILE *out = open_memstream(&client->answer, &client->num_answer);

    if (!out) {
        close_client(server, client);
        return;
    }
    fprintf(out,
            "HTTP/1.1 %s\r\nContent-Type: %s\r\nContent-Length: %zu\r\n%sConnection: close\r\n\r\n",
            status, type, size, extra);
    if (has_text) {
        fwrite(text, 1, size, out);
    }
    if (fclose(out)) {
        close_client(server, client);
        return;
    }
    client->state = CLIENT_READS;
}

static void prepare_refusal(struct page_server *server, struct client *client, const char *status,
                            const char *extra)
{
    char text[128];
    const int size = snprintf(text, sizeof text, "%s; the page is %s\n", status, server->path);

    server->refused++;
    prepare_answer(server, client, status, extra, "text/plain", text, (size_t)size, true);
}

/* Splits "GET /metrics HTTP/1.1" into its three words, in place; false for other lines. */
static bool split_request_line(char *line, char *words[3])
{
    line[strcspn(line, "\r\n")] = '\0';
    for (int i = 0; i < 3; i++) {
        words[i] = line;
        line += strcspn(line, " ");
        if (*line) {
            *line++ = '\0';
        }
    }
    return *line == '\0' && strncmp(words[2], "HTTP/1.", 7) == 0;
}

static void prepare_answer_to_request(struct page_server *server, struct client *client)
{
    char *words[3];
    bool is_head;

    client->asked[client->num_asked] = '\0';
    if (memchr(client->asked, '\0', client->num_asked) ||
        !split_request_line(client->asked, words)) {
        prepare_refusal(server, client, "400 Bad Request", "");
        return;
    }
    words[1][strcspn(words[1], "?")] = '\0';
    is_head = strcmp(words[0], "HEAD") == 0;
    if (!is_head && strcmp(words[0], "GET") != 0) {
        prepare_refusal(server, client, "405 Method Not Allowed", "Allow: GET, HEAD\r\n");
    } else if (strcmp(words[1], server->path) != 0) {
        prepare_refusal(server, client, "404 Not Found", "");
    } else if (!have_fresh_page(server)) {
        prepare_refusal(server, client, "503 Service Unavailable", "");
    } else {
        server->sent++;
        prepare_answer(server, client, "200 OK", "", server->type, server->page, server->num_page,
                       !is_head);
    }
}

/* ---- What clients say and take ---- */

static bool would_block(ssize_t done)
{
    return done < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
}

static bool has_end_of_request_head(const char *text, size_t size)
{
    return memmem(text, size, "\r\n\r\n", 4) || memmem(text, size, "\n\n", 2);
}

/* Receives one piece of a request, and answers the request once its head is complete. */
static void receive_request(struct page_server *server, struct client *client)
{
    const size_t room = sizeof client->asked - 1 - client->num_asked;
    const ssize_t got = recv(client->descriptor, client->asked + client->num_asked, room, 0);

    if (would_block(got)) {
        return;
    }
    if (got <= 0) {
        close_client(server, client);
        return;
    }
    client->num_asked += (size_t)got;
    if (has_end_of_request_head(client->asked, client->num_asked)) {
        prepare_answer_to_request(server, client);
    } else if (client->num_asked == sizeof client->asked - 1) {
        prepare_refusal(server, client, "431 Request Header Fields Too Large", "");
    }
}

static void send_answer(const struct page_server *server, struct client *client)
{
    const ssize_t done = send(client->descriptor, client->answer + client->sent,
                              client->num_answer - client->sent, MSG_NOSIGNAL);

    if (would_block(done)) {
        return;
    }
    if (done < 0) {
        close_client(server, client);
        return;
    }
    client->sent += (size_t)done;
    if (client->sent == client->num_answer) {
        shutdown(client->descriptor, SHUT_WR);
        client->state = CLIENT_ENDS;
    }
}

/*
 * Drops the client once it has closed its side. The server does not close first: data that arrive
 * late would make the kernel reset the connection, and the client could lose the answer.
 */
static void close_client_if_it_closed(const struct page_server *server, struct client *client)
{
    char text[1024];
    const ssize_t got = recv(client->descriptor, text, sizeof text, 0);

    if (got == 0 || (got < 0 && !would_block(got))) {
        close_client(server, client);
    }
}

static void serve_client(struct page_server *server, struct client *client)
{
    if (client->state == CLIENT_ASKS) {
        receive_request(server, client);
    }
    if (client->state == CLIENT_READS) {
        send_answer(server, client);
    }
    if (client->state == CLIENT_ENDS) {
        close_client_if_it_closed(server, client);
    }
    if (client->state != CLIENT_NONE) {
        struct epoll_event event = {.events = client->state == CLIENT_READS ? EPOLLOUT : EPOLLIN,
                                    .data.ptr = client};

        (void)epoll_ctl(server->poll, EPOLL_CTL_MOD, client->descriptor, &event);
    }
}

/*
 * Stops or resumes accepting: a connection that cannot be accepted would wake the poll endlessly.
 */
static void set_accepting_paused(struct page_server *server, bool is_paused)
{
    struct epoll_event event = {.events = is_paused ? 0 : EPOLLIN};

    if (is_paused != server->is_deaf &&
        epoll_ctl(server->poll, EPOLL_CTL_MOD, server->listener, &event) == 0) {
        server->is_deaf = is_paused;
    }
}

static void accept_and_serve_clients(struct page_server *server)
{
    for (int i = 0; i < ACCEPTED_MAX; i++) {
        const int descriptor = accept4(server->listener, NULL, NULL, SOCK_NONBLOCK | SOCK_CLOEXEC);
        struct client *client;
        struct epoll_event event = {.events = EPOLLIN};

        if (descriptor < 0) {
            set_accepting_paused(server, errno == EMFILE || errno == ENFILE || errno == ENOBUFS ||
                                             errno == ENOMEM);
            return;
        }
        client = claim_client_place(server);
        event.data.ptr = client;
        if (epoll_ctl(server->poll, EPOLL_CTL_ADD, descriptor, &event)) {
            close(descriptor);
            continue;
        }
        client->state = CLIENT_ASKS;
        client->descriptor = descriptor;
        client->since_us = monotonic_clock_us();
        serve_client(server, client); /* most requests have arrived with the connection */
    }
}

static void close_slow_clients(struct page_server *server)
{
    const int64_t now_us = monotonic_clock_us();

    for (unsigned i = 0; i < PLACES; i++) {
        struct client *client = &server->clients[i];

        if (client->state != CLIENT_NONE && now_us > client->since_us + LIFE_US) {
            server->refused += client->state != CLIENT_ENDS;
            close_client(server, client);
        }
    }
}

void page_server_serve(struct page_server *server)
{
    struct epoll_event events[PLACES + 1];
    int count;

    if (!server) {
        return;
    }
    close_slow_clients(server);
    count = epoll_wait(server->poll, events, PLACES + 1, 0);
    for (int i = 0; i < count; i++) {
        struct client *client = events[i].data.ptr;

        if (client && client->state != CLIENT_NONE) {
            serve_client(server, client);
        }
    }
    accept_and_serve_clients(
        server); /* accepted last: a reused client place has no event left in `events` */
}

/* ---- Start and end ---- */

static int listen_at_local_port(uint16_t port)
{
    const struct sockaddr_in address = {
        .sin_family = AF_INET, .sin_port = htons(port), .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    const int on = 1, listener = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);

    if (listener < 0 || setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) ||
        bind(listener, (const struct sockaddr *)&address, sizeof address) ||
        listen(listener, PLACES)) {
        fail(EXIT_RUNTIME, "port %u of 127.0.0.1: %s", port, strerror(errno));
    }
    return listener;
}

struct page_server *page_server_open(uint16_t port, const char *path, const char *type,
                                     page_server_write *write, void *context)
{
    struct epoll_event event = {.events = EPOLLIN};
    struct page_server *server;

    if (port == 0) {
        return NULL;
    }
    server = must_calloc(1, sizeof *server);
    server->listener = listen_at_local_port(port);
    server->poll = epoll_create1(EPOLL_CLOEXEC);
    if (server->poll < 0 || epoll_ctl(server->poll, EPOLL_CTL_ADD, server->listener, &event)) {
        fail(EXIT_RUNTIME, "epoll: %s", strerror(errno));
    }
    server->path = path;
    server->type = type;
    server->write = write;
    server->context = context;
    return server;
}

int page_server_poll_descriptor(const struct page_server *server)
{
    return server ? server->poll : -1;
}

uint64_t page_server_num_sent(const struct page_server *server)
{
    return server ? server->sent : 0;
}

uint64_t page_server_num_refused(const struct page_server *server)
{
    return server ? server->refused : 0;
}

void page_server_close(struct page_server *server)
{
    if (!server) {
        return;
    }
    for (unsigned i = 0; i < PLACES; i++) {
        if (server->clients[i].state != CLIENT_NONE) {
            close_client(server, &server->clients[i]);
        }
    }
    close(server->poll);
    close(server->listener);
    free(server->page);
    free(server);
}
