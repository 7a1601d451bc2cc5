// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Window;
import java.awt.event.ActionEvent;
import java.io.IOException;
import java.util.Arrays;
import java.util.Optional;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.JOptionPane;
import javax.swing.SwingUtilities;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

import rhotrack.spy.scene.Decoder;
import rhotrack.spy.scene.Feed;
import rhotrack.spy.scene.LcmUrl;
import rhotrack.spy.scene.Model;

/**
 * The plug-in that lcm-spy finds on its class path: any channel of rhotrack opens the one window
 * that shows all, beside lcm-spy's.
 */
public final class SpyView implements SpyPlugin {
    private static final String SPY_TITLE = "LCM Spy";

    private ViewerWindow window;

    @Override
    public boolean canHandle(long fingerprint) {
        return Decoder.knows(fingerprint);
    }

    @Override
    @SuppressWarnings("serial") // nobody stores actions
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new AbstractAction("rhotrack view") {
            @Override
            public void actionPerformed(ActionEvent event) {
                closeEmpty(desktop, channel);
                open();
            }
        };
    }

    /** lcm-spy makes a window for what a plug-in shows, which would stay empty. */
    private static void closeEmpty(JDesktopPane desktop, ChannelData channel) {
        if (SwingUtilities.getWindowAncestor(desktop) instanceof JFrame frame
                && frame.getTitle().equals(channel.name) && desktop.getAllFrames().length == 0) {
            frame.dispose();
        }
    }

    private static Optional<Window> spyWindow() {
        return Arrays.stream(Window.getWindows())
                .filter(one -> one.isVisible() && one instanceof JFrame frame && SPY_TITLE.equals(frame.getTitle()))
                .findFirst();
    }

    private void open() {
        if (window != null && window.isOpen()) {
            window.toFront();
            return;
        }
        try {
            Model model = new Model();
            Feed feed = new Feed(LcmUrl.ofThisProcess(), model);
            window = new ViewerWindow(model, feed, Viewer.WIDTH, Viewer.HEIGHT);
            spyWindow().ifPresent(window::placeBeside);
            window.open();
        } catch (IOException e) {
            JOptionPane.showMessageDialog(null, e.getMessage(), "rhotrack", JOptionPane.ERROR_MESSAGE);
        }
    }
}
